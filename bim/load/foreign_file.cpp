// SPDX-License-Identifier: Apache-2.0
#include "bim/load/foreign_file.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>

#include "bim/config/utf8.h"
#include "bim/errors.h"
#include "bim/formats/mesh/mesh_file.h"

namespace plumbline::bim {

namespace {

using namespace std::string_view_literals;

/// What a file is and what to do with it.
struct Foreign {
  std::string_view what;
  std::string_view help;
};

constexpr std::string_view give_inside = "unpack it and give the file that is in it";
constexpr std::string_view as_ifc = "export the building from the program that made it, as IFC";

struct Signature {
  std::string_view head;
  Foreign file;
};

/// Of files that are no mesh of any kind either.
constexpr std::array<Signature, 9> archives{{
    {"PK\x03\x04"sv, {"a zip archive, such as ifcZIP", "unpack it and give the .ifc that is in it"}},
    {"PK\x05\x06"sv, {"a zip archive that is empty", "give the building itself"}},
    {"\x1f\x8b"sv, {"packed by gzip", give_inside}},
    {"7z\xbc\xaf\x27\x1c"sv, {"a 7z archive", give_inside}},
    {"Rar!\x1a"sv, {"a RAR archive", give_inside}},
    {"BZh"sv, {"packed by bzip2", give_inside}},
    {"\xfd\x37zXZ"sv, {"packed by xz", give_inside}},
    {"\x28\xb5\x2f\xfd"sv, {"packed by zstd", give_inside}},
    {"version https://git-lfs"sv, {"a pointer of Git LFS and not the file", "get the file by `git lfs pull`"}},
}};

constexpr std::array<Signature, 8> others{{
    {"\xff\xfe"sv, {"text in UTF-16", "save it as UTF-8, by `iconv -f UTF-16 -t UTF-8` or an editor"}},
    {"\xfe\xff"sv, {"text in UTF-16", "save it as UTF-8, by `iconv -f UTF-16 -t UTF-8` or an editor"}},
    {"\xd0\xcf\x11\xe0"sv, {"a project of a CAD program, such as Revit", as_ifc}},
    {"AC10"sv, {"a DWG drawing", as_ifc}},
    {"%PDF"sv, {"a PDF", as_ifc}},
    {"Kaydara FBX"sv, {"an FBX mesh", "save it as .glb"}},
    {"glTF"sv, {"a binary glTF mesh", "let its name end in .glb"}},
    {"ply\n"sv, {"a PLY mesh", "let its name end in .ply"}},
}};

std::string_view without_mark_and_blanks(std::string_view text) {
  text = without_byte_order_mark(text);
  const std::size_t begin = text.find_first_not_of(" \t\r\n");
  return begin == std::string_view::npos ? std::string_view() : text.substr(begin);
}

/// The beginning of a text in small letters.
std::string small_head(std::string_view text) {
  constexpr std::size_t enough = 4096;
  std::string head(text.substr(0, enough));
  std::transform(head.begin(), head.end(), head.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return head;
}

bool holds_one_of(const std::string& text, std::initializer_list<std::string_view> words) {
  return std::any_of(words.begin(), words.end(),
                     [&](std::string_view word) { return text.find(word) != std::string::npos; });
}

const Foreign* known_by_head(std::string_view bytes, const auto& signatures) {
  const auto found = std::find_if(signatures.begin(), signatures.end(),
                                  [&](const Signature& signature) { return bytes.starts_with(signature.head); });
  return found == signatures.end() ? nullptr : &found->file;
}

Foreign markup(const std::string& head) {
  if (holds_one_of(head, {"<!doctype html", "<html"}))
    return {"a web page and not the file", "download the file itself"};
  if (holds_one_of(head, {"<collada"})) return {"a COLLADA mesh", "let its name end in .dae"};
  if (holds_one_of(head, {"ifcxml", "buildingsmart", "<ifc", "ifc2x3", "ifc4"}))
    return {"ifcXML", "export the building as IFC in STEP text (.ifc)"};
  return {"XML", "give a plan, an IFC file in STEP text (.ifc) or a mesh"};
}

/// Nothing for what may be a plan or a scenario, which are YAML: its braces may be JSON's.
Foreign in_json(const std::string& head) {
  const std::size_t first = head.find_first_not_of("{[ \t\r\n");
  if (first == std::string::npos || head[first] != '"') return {};
  if (holds_one_of(head, {"\"plan\"", "\"scenario\"", "\"levels\"", "\"sweep\""})) return {};
  if (holds_one_of(head, {"ifc"})) return {"IFC as JSON", "export the building as IFC in STEP text (.ifc)"};
  if (holds_one_of(head, {"\"asset\"", "\"bufferviews\"", "\"accessors\""}))
    return {"a glTF mesh as JSON", "save it as .glb"};
  return {};
}

/// Text whose letters take two bytes each, without a mark in front.
bool is_wide(std::string_view bytes) {
  constexpr std::size_t looked_at = 8;
  if (bytes.size() < looked_at) return false;
  for (const std::size_t first : {0U, 1U}) {
    bool wide = true;
    for (std::size_t i = 0; i < looked_at; ++i) wide = wide && (bytes[i] == '\0') == (i % 2 == first);
    if (wide) return true;
  }
  return false;
}

Foreign foreign(std::string_view bytes, const std::string& path) {
  if (const Foreign* archive = known_by_head(bytes, archives)) return *archive;
  if (is_mesh_path(path)) return {};
  if (const Foreign* other = known_by_head(bytes, others)) return *other;
  if (is_wide(bytes)) return others.front().file;
  const std::string_view text = without_mark_and_blanks(bytes);
  if (text.starts_with('<')) return markup(small_head(text));
  if (text.starts_with('{') || text.starts_with('[')) return in_json(small_head(text));
  return {};
}

}  // namespace

void refuse_foreign_file(std::string_view bytes, const std::string& path) {
  const Foreign file = foreign(bytes, path);
  if (!file.what.empty())
    throw InputError({path, 0, 0}, "is " + std::string(file.what) + "; " + std::string(file.help));
}

}  // namespace plumbline::bim
