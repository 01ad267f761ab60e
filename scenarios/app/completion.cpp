// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/completion.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string_view>

#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/host/terminal.h"
#include "scenarios/spec/library.h"
#include "scenarios/spec/method_names.h"

namespace plumbline::scenarios {

namespace {

enum class ValueKind { none, methods, scenarios, folder, words, file, other };

struct ValueOf {
  ValueKind kind = ValueKind::none;
  std::vector<std::string> words;
};

/// What the help calls the value says what may stand there.
ValueOf value_of(const OptionHelp& option) {
  const std::string& name = option.value;
  if (name.empty()) return {};
  if (name.starts_with("METHOD")) return {ValueKind::methods, {}};
  if (name.starts_with("SCENARIO")) return {ValueKind::scenarios, {}};
  if (name.starts_with("DIR")) return {ValueKind::folder, {}};
  const std::size_t open = name.find('{');
  const std::size_t close = name.rfind('}');
  if (open != std::string::npos && close != std::string::npos && close > open) {
    ValueOf value{ValueKind::words, {}};
    for (std::size_t begin = open + 1; begin < close;) {
      const std::size_t end = std::min(name.find(',', begin), close);
      value.words.push_back(name.substr(begin, end - begin));
      begin = end + 1;
    }
    return value;
  }
  return {name.starts_with("TEXT") ? ValueKind::file : ValueKind::other, {}};
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

// Bash ----------------------------------------------------------------------------------------------------------------

/// What fills COMPREPLY for a value; with the variables `word`, the part of it that is there.
std::string bash_value(const ValueOf& value) {
  switch (value.kind) {
    case ValueKind::methods:
      return "_plumbline_list \"$methods\"";
    case ValueKind::scenarios:
      return "_plumbline_words \"$scenarios\"; _plumbline_files -f";
    case ValueKind::folder:
      return "_plumbline_files -d";
    case ValueKind::words:
      return "_plumbline_words " + shell_argument(joined(value.words));
    case ValueKind::file:
      return "_plumbline_files -f";
    case ValueKind::none:
    case ValueKind::other:
      break;
  }
  return ":";
}

constexpr std::string_view bash_functions = R"sh(
_plumbline_words() { mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen -W "$1" -- "$word"); }
_plumbline_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t -O "${#COMPREPLY[@]}" COMPREPLY < <(compgen "$1" -- "$word")
}
_plumbline_list() {
  local before=
  [[ $word == *,* ]] && before=${word%,*},
  mapfile -t COMPREPLY < <(compgen -P "$before" -W "$1" -- "${word##*,}")
}
)sh";

// Where `=` breaks words (COMP_WORDBREAKS), --option=value comes as three of them.
constexpr std::string_view bash_begin = R"sh(
_plumbline() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} at=$1 i commands options
  at=${at##*/}
  COMPREPLY=()
  if [[ $word == = ]]; then
    word=
  elif [[ $before == = ]] && ((COMP_CWORD > 2)); then
    before=${COMP_WORDS[COMP_CWORD - 2]}
  fi
)sh";

constexpr std::string_view bash_end = R"sh(
  if [[ $word == -* ]]; then
    _plumbline_words "$options"
  else
    _plumbline_words "$commands"
    _plumbline_position
  fi
}
)sh";

std::string bash_commands(const std::vector<CommandHelp>& help) {
  std::string text = "  for ((i = 1; i < COMP_CWORD; ++i)); do\n    case \"$at ${COMP_WORDS[i]}\" in\n      ";
  for (std::size_t i = 1; i < help.size(); ++i) text += (i == 1 ? "" : "|") + shell_argument(help[i].command);
  text += ") at=\"$at ${COMP_WORDS[i]}\" ;;\n    esac\n  done\n  case $at in\n";
  for (const CommandHelp& command : help) {
    std::string options;
    for (const OptionHelp& option : command.options)
      if (!option.positional) options += (options.empty() ? "" : " ") + joined(option.names);
    text += "    " + shell_argument(command.command) + ") commands=" + shell_argument(joined(command.commands)) +
            " options=" + shell_argument(options) + " ;;\n";
  }
  return text + "  esac\n";
}

std::string bash_options(const std::vector<CommandHelp>& help) {
  std::string text = "  case \"$at $before\" in\n";
  for (const CommandHelp& command : help)
    for (const OptionHelp& option : command.options) {
      const ValueOf value = value_of(option);
      if (option.positional || value.kind == ValueKind::none) continue;
      std::string names;
      for (const std::string& name : option.names)
        names += (names.empty() ? "" : "|") + shell_argument(command.command + " " + name);
      text += "    " + names + ") " + bash_value(value) + "; return ;;\n";
    }
  return text + "  esac\n";
}

std::string bash_positions(const std::vector<CommandHelp>& help) {
  std::string text = "\n_plumbline_position() {\n  case $at in\n";
  for (const CommandHelp& command : help) {
    std::string values;
    for (const OptionHelp& option : command.options)  // they are of one kind in every command
      if (option.positional && values.empty()) values = bash_value(value_of(option));
    if (values.empty() && !command.commands.empty()) values = ":";  // its subcommands stand there
    if (!values.empty()) text += "    " + shell_argument(command.command) + ") " + values + " ;;\n";
  }
  return text + "    *) _plumbline_files -f ;;\n  esac\n}\n";
}

// Zsh -----------------------------------------------------------------------------------------------------------------

std::string zsh_value(const ValueOf& value, const std::string& name) {
  switch (value.kind) {
    case ValueKind::methods:
      return ":method:_sequence compadd - $methods";
    case ValueKind::scenarios:
      return ":scenario:_plumbline_inputs";
    case ValueKind::folder:
      return ":directory:_files -/";
    case ValueKind::words:
      return ":" + name + ":(" + joined(value.words) + ")";
    case ValueKind::file:
      return ":" + name + ":_files";
    case ValueKind::other:
      return ":" + name + ": ";
    case ValueKind::none:
      break;
  }
  return {};
}

/// The first line of a help, without what means something in a specification.
std::string zsh_doc(const std::string& doc) {
  std::string out;
  for (const char c : doc.substr(0, std::min(doc.find('\n'), doc.find(" [")))) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

/// One specification of _arguments a name.
std::string zsh_option(const OptionHelp& option) {
  std::string text;
  const std::string& last = option.names.back();
  const std::string value = zsh_value(value_of(option), option.positional ? last : last.substr(2));
  if (option.positional)
    return " \\\n    " +
           shell_argument((option.many ? "*:" : ":") + option.names[0] + value.substr(value.find(':', 1)));
  const std::string other = option.many ? "*" : "(" + joined(option.names) + ")";
  for (const std::string& name : option.names) {
    const char* ending = value.empty() ? "" : name.starts_with("--") ? "=" : "+";
    text += " \\\n    " + shell_argument(other + name + ending + "[" + zsh_doc(option.doc) + "]" + value);
  }
  return text;
}

std::string zsh_function(const std::string& command) {
  std::string name = "_" + command;
  std::replace_if(
      name.begin(), name.end(), [](char c) { return c == ' ' || c == '-'; }, '_');
  return name;
}

std::string zsh_command(const std::vector<CommandHelp>& help, const CommandHelp& command) {
  std::string text = "\n" + zsh_function(command.command) + "() {\n  _arguments -C -S";
  for (const OptionHelp& option : command.options)
    text += command.commands.empty() || !option.positional ? zsh_option(option) : "";
  if (command.commands.empty()) return text + "\n}\n";
  text += " \\\n    '1: :->command' '*:: :->rest'\n  case $state in\n    command)\n      local -a commands=(";
  for (const CommandHelp& below : help)
    for (const std::string& name : command.commands)
      if (below.command == command.command + " " + name)
        text += "\n        " + shell_argument(name + ":" + zsh_doc(below.summary));
  text += ")\n      _describe command commands";
  for (const OptionHelp& option : command.options)
    if (option.positional && value_of(option).kind == ValueKind::file) text += "\n      _files";
  text += " ;;\n    rest)\n      case $words[1] in\n";
  for (const std::string& name : command.commands)
    text += "        " + name + ") " + zsh_function(command.command + " " + name) + " ;;\n";
  return text + "        *) _files ;;\n      esac ;;\n  esac\n}\n";
}

KnownNames known_names(slam::MethodTable table) {
  KnownNames names;
  for (const slam::MethodRow& row : table) names.methods.emplace_back(row.name);
  names.methods.emplace_back(truth_method);
  const std::string folder = library_folder();
  if (folder.empty()) return names;
  for (const std::string& path : scenario_files(folder))
    names.scenarios.push_back(std::filesystem::path(path).lexically_relative(folder).replace_extension().string());
  return names;
}

}  // namespace

std::string bash_completion(const std::vector<CommandHelp>& help, const KnownNames& names) {
  const std::string& program = help.front().command;
  std::string text = "# Completion of " + program + " for bash; " + program + " completion bash prints it.\n";
  text += bash_functions;
  text += bash_positions(help);
  text += bash_begin;
  text += "  local methods=" + shell_argument(joined(names.methods)) +
          "\n  local scenarios=" + shell_argument(joined(names.scenarios)) + "\n";
  text += bash_commands(help) + bash_options(help);
  text += bash_end;
  return text + "complete -F _plumbline " + program + "\n";
}

std::string zsh_completion(const std::vector<CommandHelp>& help, const KnownNames& names) {
  const std::string& program = help.front().command;
  std::string text =
      "#compdef " + program + "\n# Completion of " + program + " for zsh; " + program + " completion zsh prints it.\n";
  text += "\n_plumbline_inputs() {\n  local -a scenarios=(" + joined(names.scenarios) +
          ")\n  _alternative \"scenarios:scenario:($scenarios)\" 'files:file:_files'\n}\n";
  for (std::size_t i = help.size(); i-- > 1;) text += zsh_command(help, help[i]);
  std::string main = zsh_command(help, help.front());
  const std::string opening = "() {\n";
  main.insert(main.find(opening) + opening.size(),
              "  local curcontext=$curcontext state line\n  local -a methods=(" + joined(names.methods) + ")\n");
  return text + main + "\nif [[ $zsh_eval_context[-1] == loadautofunc ]]; then\n  " + zsh_function(program) +
         " \"$@\"\nelse\n  compdef " + zsh_function(program) + " " + program + "\nfi\n";
}

Command add_completion(CommandLine& program, slam::MethodTable table) {
  const auto shell = std::make_shared<std::string>();
  CommandLine line =
      program.add_command("completion", "Prints a script that completes commands, options and names in a shell");
  line.option("SHELL", *shell, "bash or zsh").one_of({"bash", "zsh"}).required();
  line.footer("Example: source <(plumbline completion bash)");
  return {line, [shell, program, table] {
            const KnownNames names = known_names(table);
            const std::string text =
                *shell == "bash" ? bash_completion(program.help(), names) : zsh_completion(program.help(), names);
            std::fwrite(text.data(), 1, text.size(), stdout);
            return 0;
          }};
}

}  // namespace plumbline::scenarios
