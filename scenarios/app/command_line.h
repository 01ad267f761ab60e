// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace plumbline::scenarios {

/// What may stand on a command's line.
struct OptionHelp {
  std::vector<std::string> names;  ///< with their dashes; of a value by position, what the help calls it
  std::string value;               ///< as the help has it, as DIR or TEXT:{all,lidar}; empty for a flag
  std::string doc;
  bool positional = false;
  bool many = false;  ///< takes several values
};

/// What a command prints for --help, whole and in parts.
struct CommandHelp {
  std::string command;  ///< as typed: "plumbline run"
  std::string text;
  std::string summary;
  std::string usage;                  ///< after the command's name
  std::vector<OptionHelp> options;    ///< in the order of the help; without hidden ones
  std::vector<std::string> commands;  ///< below this one
  std::string footer;
};

/// What an argument may be, given one after the other: line.option(...).required().
class Argument {
 public:
  explicit Argument(CLI::Option* option) : option_(option) {}

  Argument& required();
  Argument& range(int least, int most);
  Argument& range(double least, double most);
  Argument& positive();  ///< and no more than 1e6
  Argument& one_of(const std::vector<std::string>& words);
  Argument& delimiter(char between);
  Argument& environment(const std::string& variable);  ///< stands in where the argument is not given
  Argument& needs(const Argument& other);
  Argument& shows_default();
  /// What the help calls the value; shells complete METHOD, SCENARIO, DIR and {one,of,these}, and else names of files.
  Argument& takes(const std::string& what);
  Argument& hidden();

  /// The long one, with its dashes.
  [[nodiscard]] std::string name() const;
  /// Whether the command line that was read has it.
  [[nodiscard]] bool given() const;

 private:
  CLI::Option* option_;
};

/// The program's command line or that of one of its subcommands. Copies are the same line. Values are written when the
/// line is read and must live until then.
class CommandLine {
 public:
  CommandLine(const std::string& summary, const std::string& name);

  [[nodiscard]] CommandLine add_command(const std::string& name, const std::string& summary);

  /// `name`: NAME by position, or "-n,--name".
  /// An empty text is refused.
  Argument option(const std::string& name, std::string& value, const std::string& doc = "");
  Argument option(const std::string& name, std::vector<std::string>& value, const std::string& doc);
  Argument option(const std::string& name, int& value, const std::string& doc);
  Argument option(const std::string& name, double& value, const std::string& doc);
  /// A whole number that a scenario's seed may be.
  Argument seed(const std::string& name, std::uint64_t& value, const std::string& doc);
  Argument flag(const std::string& name, bool& value, const std::string& doc);

  void version(const std::string& text);
  void footer(const std::string& text);
  void needs_command();
  /// At most one subcommand, which the help calls so; what is none of them is left to the action to refuse.
  void takes_command_or_any(const std::string& what);

  /// All words from the first on that is no option are left as they are; the help calls them so.
  void takes_rest(const std::string& what);
  [[nodiscard]] std::vector<std::string> rest() const;

  /// Reads the arguments after the program's name. False where help or version was asked for, which is then printed.
  /// Throws InputError.
  [[nodiscard]] bool parse(const std::vector<std::string>& arguments);

  /// Whether the line that was read names this subcommand.
  [[nodiscard]] bool asked() const;
  [[nodiscard]] std::string name() const;
  /// Of this line and of every command below it, each before its own.
  [[nodiscard]] std::vector<CommandHelp> help() const;

 private:
  explicit CommandLine(std::shared_ptr<CLI::App> app) : app_(std::move(app)) {}
  /// Help that is asked for after a word that is no command would hide the mistake. Throws InputError.
  void check_commands(const std::vector<std::string>& arguments) const;
  [[nodiscard]] std::string error_text(const std::vector<std::string>& arguments, const std::string& what) const;
  template <class T>
  Argument add(const std::string& name, T& value, const std::string& doc);
  template <class T>
  Argument add_words(const std::string& name, T& value, const std::string& doc);

  std::shared_ptr<CLI::App> app_;
};

}  // namespace plumbline::scenarios
