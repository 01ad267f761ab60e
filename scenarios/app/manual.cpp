// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/manual.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string_view>

#include "bim/errors.h"
#include "scenarios/app/commands.h"
#include "scenarios/host/files.h"

namespace plumbline::scenarios {

namespace fs = std::filesystem;

namespace {

/// Of one line of text: no character of it is a request, and a dash stays one that can be copied.
std::string roff(std::string_view text) {
  std::string out;
  if (text.starts_with('.') || text.starts_with('\'')) out = "\\&";
  for (const char c : text) {
    if (c == '\\') {
      out += "\\e";
    } else {
      if (c == '-') out += '\\';
      out += c;
    }
  }
  return out;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// What a line break of the help begins anew begins anew here, too.
std::string paragraph(const std::string& text) {
  std::string out;
  for (const std::string& line : lines_of(text)) {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    out += (out.empty() ? "" : ".br\n") + roff(line.substr(begin)) + "\n";
  }
  return out;
}

std::string dashed(std::string command) {
  std::replace(command.begin(), command.end(), ' ', '-');
  return command;
}

std::string option_section(const CommandHelp& command, bool positional) {
  std::string text;
  for (const OptionHelp& option : command.options) {
    if (option.positional != positional) continue;
    text += ".TP\n";
    for (std::size_t i = 0; i < option.names.size(); ++i) text += (i == 0 ? "" : ", ") + bold(option.names[i]);
    if (!option.value.empty() && !positional)
      text += " \\fI" + roff(option.value) + "\\fR" + (option.many ? " ..." : "");
    text += "\n" + (option.doc.empty() ? "\\&\n" : paragraph(option.doc));
  }
  return text;
}

/// Examples as they are typed, codes and notes as paragraphs.
std::string footer_sections(const std::string& footer) {
  constexpr std::string_view examples = "Example: ";
  constexpr std::string_view codes = "Exit codes: ";
  std::string example;
  std::string exits;
  std::string notes;
  bool in_example = false;
  for (const std::string& line : lines_of(footer)) {
    in_example = line.starts_with(examples) || (in_example && line.starts_with(' '));
    if (in_example)
      example += roff(line.substr(std::min(examples.size(), line.size()))) + "\n";
    else if (line.starts_with(codes))
      exits += roff(line.substr(codes.size())) + "\n";
    else if (!line.empty())
      notes += ".PP\n" + roff(line) + "\n";
  }
  std::string text;
  if (!notes.empty()) text += ".SH NOTES\n" + notes;
  if (!exits.empty()) text += ".SH \"EXIT STATUS\"\n" + exits;
  if (!example.empty()) text += ".SH EXAMPLES\n.nf\n" + example + ".fi\n";
  return text;
}

std::string command_text(const CommandHelp& command) {
  std::string text = ".SH SYNOPSIS\n" + bold(command.command) + " " + roff(command.usage) + "\n";
  text += ".SH DESCRIPTION\n" + paragraph(command.summary);
  if (const std::string values = option_section(command, true); !values.empty()) text += ".SH ARGUMENTS\n" + values;
  if (const std::string options = option_section(command, false); !options.empty()) text += ".SH OPTIONS\n" + options;
  return text;
}

/// One that stands below a command, as a part of its page.
std::string part_text(const CommandHelp& command) {
  return ".SS \"" + roff(command.command) + "\"\n" + bold(command.command) + " " + roff(command.usage) + "\n.PP\n" +
         paragraph(command.summary) + option_section(command, true) + option_section(command, false);
}

}  // namespace

std::vector<ManualPage> manual_pages(const std::vector<CommandHelp>& help, const std::string& version) {
  std::vector<ManualPage> pages;
  const std::string& program = help.front().command;
  for (std::size_t i = 0; i < help.size(); ++i) {
    const CommandHelp& command = help[i];
    const std::string name = dashed(command.command);
    if (std::count(command.command.begin(), command.command.end(), ' ') > 1) continue;
    std::string text = ".TH \"" + upper(roff(name)) + "\" 1 \"\" \"" + roff(version) + "\" \"User commands\"\n";
    text += ".SH NAME\n" + roff(name) + " \\- " + roff(command.summary) + "\n" + command_text(command);
    std::string parts;
    for (const CommandHelp& part : help) {
      const bool below = part.command.starts_with(command.command + " ");
      if (i == 0 && std::count(part.command.begin(), part.command.end(), ' ') == 1)
        parts += ".TP\n" + bold(dashed(part.command)) + "(1)\n" + paragraph(part.summary);
      else if (i > 0 && below)
        parts += part_text(part);
    }
    if (!parts.empty()) text += ".SH COMMANDS\n" + parts;
    text += footer_sections(command.footer);
    if (i > 0) text += ".SH \"SEE ALSO\"\n" + bold(program) + "(1)\n";
    pages.push_back({name + ".1", text});
  }
  return pages;
}

Command add_manual(CommandLine& program) {
  struct Options {
    std::string out;
    bool force = false;
  };
  const auto options = std::make_shared<Options>();
  CommandLine line = program.add_command("manual", "Writes a page for man of the program and of each of its commands");
  line.option("-o,--out", options->out, "folder to write the pages into").takes("DIR").required();
  line.flag("--force", options->force, "replace pages that are there");
  line.footer("Example: plumbline manual -o man && man man/plumbline-run.1");
  return {line, [options, program] {
            const auto pages = manual_pages(program.help(), std::string("plumbline ") + PLUMBLINE_VERSION);
            for (const ManualPage& page : pages)
              if (const std::string path = options->out + "/" + page.file; !options->force && fs::exists(path))
                throw InputError({path, 0, 0}, "exists already; --force replaces it");
            make_folders(options->out, options->out);
            for (const ManualPage& page : pages) write_file(options->out + "/" + page.file, page.text);
            return 0;
          }};
}

}  // namespace plumbline::scenarios
