# SPDX-License-Identifier: Apache-2.0
# Groups sources to be compiled together, sixteen at most, so that no two of a group name something alike for themselves
# alone (in an unnamed namespace), and none names something like a function of a header that another one mentions. A
# source that names something like a type of a header stays by itself.
# Usage: awk -f ci/join.awk HEADER... SOURCE...; prints a line SOURCE GROUP for each source.
function name_of(line) {
  sub(/^\[\[[a-z_]*\]\] /, "", line)
  if (line ~ /^(struct|class|enum class|enum) /) {
    sub(/^(struct|class|enum class|enum) /, "", line)
    sub(/[^A-Za-z0-9_].*/, "", line)
    return line
  }
  if (line ~ /^using [A-Za-z0-9_]* =/) {
    sub(/^using /, "", line)
    sub(/ .*/, "", line)
    return line
  }
  if (line !~ /^[A-Za-z]/ || line ~ /^(using|namespace|template|public|private|TEST|INSTANTIATE)/) return ""
  while (sub(/<[^<>]*>/, "", line)) continue
  sub(/[(={;].*/, "", line)
  sub(/\[.*/, "", line)
  sub(/ *$/, "", line)
  sub(/.*[^A-Za-z0-9_]/, "", line)
  return line
}
function fits(file, group, i) {
  for (i = 1; i <= names[file]; ++i)
    if ((group, name[file, i]) in taken || ((group, name[file, i]) in mentioned && name[file, i] in declared)) return 0
  for (i = 1; i <= words[file]; ++i)
    if ((group, word[file, i]) in taken && word[file, i] in declared) return 0
  return 1
}
FILENAME ~ /\.h$/ {
  if ($0 ~ /^(struct|class|enum class) [A-Za-z0-9_]+/) typed[name_of($0)] = 1
  else if ($0 ~ /^[[A-Za-z].*\(/) declared[name_of($0)] = 1
  next
}
FNR == 1 { files[++count] = FILENAME; inside = 0; names[FILENAME] = words[FILENAME] = 0 }
{
  line = $0
  while (match(line, /[A-Za-z_][A-Za-z0-9_]*\(/)) {
    called = substr(line, RSTART, RLENGTH - 1)
    line = substr(line, RSTART + RLENGTH)
    if ((called in declared) && !((FILENAME, called) in seen)) {
      seen[FILENAME, called] = 1
      word[FILENAME, ++words[FILENAME]] = called
    }
  }
}
/^namespace \{/ { inside = 1; next }
/^}  \/\/ namespace$/ { inside = 0 }
inside && /^[A-Za-z\[]/ { own = name_of($0); if (own != "") name[FILENAME, ++names[FILENAME]] = own }
END {
  most = 16
  for (f = 1; f <= count; ++f) {
    file = files[f]
    alone = 0
    for (i = 1; i <= names[file]; ++i) if (name[file, i] in typed) alone = 1
    for (group = alone ? groups + 1 : 1; group <= groups; ++group)
      if (size[group] < most && fits(file, group)) break
    if (group > groups) groups = group
    size[group] += alone ? most : 1
    for (i = 1; i <= names[file]; ++i) taken[group, name[file, i]] = 1
    for (i = 1; i <= words[file]; ++i) mentioned[group, word[file, i]] = 1
    print file, group
  }
}
