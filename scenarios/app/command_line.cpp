// SPDX-License-Identifier: Apache-2.0
#include "scenarios/app/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "bim/config/tree.h"
#include "bim/errors.h"

namespace plumbline::scenarios {

namespace {

/// A whole number, decimal, as many as a scenario's `seed:` takes.
std::string check_seed(std::string& text) {
  constexpr std::string_view most = "9200000000000000000";
  const bool digits =
      !text.empty() && std::all_of(text.begin(), text.end(), [](char c) { return c >= '0' && c <= '9'; });
  const std::string number = digits ? text.substr(std::min(text.find_first_not_of('0'), text.size() - 1)) : "";
  if (!digits || number.size() > most.size() || (number.size() == most.size() && number > most))
    return "'" + text + "' is not a seed; give a whole number from 0 to " + std::string(most);
  text = number;
  return {};
}

/// Finite and above 0; of what is measured in metres and seconds, which no larger number makes sense of.
std::string check_positive(std::string& text) {
  constexpr double most = 1e6;
  double value = 0.0;
  if (CLI::detail::lexical_cast(text, value) && value > 0.0 && value <= most) return {};
  return "'" + text + "' must be a number above 0, 1000000 at most";
}

/// An empty word where a name belongs is most often a variable of a shell that was not set.
std::string check_not_empty(std::string& text) { return text.empty() ? "must not be empty" : ""; }

std::string guess_of(const std::string& word, const std::vector<std::string>& known) {
  const std::string guess = did_you_mean(word, known);
  return guess.empty() ? "" : "; did you mean '" + guess + "'?";
}

/// The first option that none of these lines has, in words; empty where there is none.
std::string unknown_option(const std::vector<const CLI::App*>& lines, const std::vector<std::string>& arguments) {
  std::vector<std::string> known;
  for (const CLI::App* line : lines)
    for (const CLI::Option* option : line->get_options())
      for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  for (const std::string& argument : arguments) {
    const std::string word = argument.substr(0, argument.find('='));
    if (word.size() < 2 || word[0] != '-' || (word[1] >= '0' && word[1] <= '9')) continue;
    const auto has = [&](const CLI::App* line) { return line->get_option_no_throw(word) != nullptr; };
    if (std::none_of(lines.begin(), lines.end(), has)) return "unknown option '" + word + "'" + guess_of(word, known);
  }
  return {};
}

}  // namespace

Argument& Argument::required() {
  option_->required();
  return *this;
}

Argument& Argument::range(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Argument& Argument::range(double least, double most) {
  const std::string between = format_number(least) + " to " + format_number(most);
  option_->check(CLI::Validator(
      [least, most, between](std::string& text) {
        double value = 0.0;
        const bool in = CLI::detail::lexical_cast(text, value) && value >= least && value <= most;  // false: NaN
        return in ? std::string() : "'" + text + "' must be a number from " + between;
      },
      "FLOAT in [" + between + "]"));
  return *this;
}

Argument& Argument::positive() {
  option_->check(CLI::Validator(check_positive, "POSITIVE"));
  return *this;
}

Argument& Argument::one_of(const std::vector<std::string>& words) {
  option_->check(CLI::IsMember(words));
  return *this;
}

Argument& Argument::delimiter(char between) {
  option_->delimiter(between);
  return *this;
}

Argument& Argument::environment(const std::string& variable) {
  option_->envname(variable);
  return *this;
}

Argument& Argument::needs(const Argument& other) {
  option_->needs(other.option_);
  return *this;
}

Argument& Argument::shows_default() {
  option_->capture_default_str();
  return *this;
}

Argument& Argument::takes(const std::string& what) {
  option_->type_name(what);
  return *this;
}

Argument& Argument::hidden() {
  option_->group("");
  return *this;
}

std::string Argument::name() const { return "--" + option_->get_lnames().front(); }

bool Argument::given() const { return option_->count() > 0; }

namespace {

/// Help of a command that is followed by more than options and values.
class OneOf : public CLI::Formatter {
 public:
  explicit OneOf(std::string what) : what_(std::move(what)) {}
  std::string make_usage(const CLI::App* /*app*/, std::string name) const override {
    return "Usage: " + name + " " + what_ + "\n";
  }

 private:
  std::string what_;
};

}  // namespace

CommandLine::CommandLine(const std::string& summary, const std::string& name)
    : app_(std::make_shared<CLI::App>(summary, name)) {}

CommandLine CommandLine::add_command(const std::string& name, const std::string& summary) {
  return CommandLine(std::shared_ptr<CLI::App>(app_, app_->add_subcommand(name, summary)));
}

template <class T>
Argument CommandLine::add(const std::string& name, T& value, const std::string& doc) {
  return Argument(app_->add_option(name, value, doc));
}

template <class T>
Argument CommandLine::add_words(const std::string& name, T& value, const std::string& doc) {
  CLI::Option* option = app_->add_option(name, value, doc);
  option->check(CLI::Validator(check_not_empty, ""));
  return Argument(option);
}

Argument CommandLine::option(const std::string& name, std::string& value, const std::string& doc) {
  return add_words(name, value, doc);
}

Argument CommandLine::option(const std::string& name, std::vector<std::string>& value, const std::string& doc) {
  return add_words(name, value, doc);
}

Argument CommandLine::option(const std::string& name, int& value, const std::string& doc) {
  return add(name, value, doc);
}

Argument CommandLine::seed(const std::string& name, std::uint64_t& value, const std::string& doc) {
  const Argument argument = add(name, value, doc);
  app_->get_option(name)->transform(CLI::Validator(check_seed, ""));
  return argument;
}

Argument CommandLine::option(const std::string& name, double& value, const std::string& doc) {
  return add(name, value, doc);
}

Argument CommandLine::flag(const std::string& name, bool& value, const std::string& doc) {
  return Argument(app_->add_flag(name, value, doc));
}

void CommandLine::version(const std::string& text) { app_->set_version_flag("--version", text); }

void CommandLine::footer(const std::string& text) { app_->footer(text); }

void CommandLine::needs_command() { app_->require_subcommand(1); }

void CommandLine::takes_command_or_any(const std::string& what) {
  app_->require_subcommand(0, 1);
  app_->formatter(std::make_shared<OneOf>(what + " [OPTIONS]"));
  app_->allow_extras();
}

void CommandLine::takes_rest(const std::string& what) {
  app_->formatter(std::make_shared<OneOf>("[OPTIONS] " + what));
  app_->prefix_command();
}

std::vector<std::string> CommandLine::rest() const {
  std::vector<std::string> words = app_->remaining();
  if (!words.empty() && words.front() == "--") words.erase(words.begin());
  return words;
}

bool CommandLine::parse(const std::vector<std::string>& arguments) {
  try {
    app_->parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // the last stands first there
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      check_commands(arguments);
      return app_->exit(error) != 0;
    }
    throw InputError({name(), 0, 0}, error_text(arguments, error.what()));
  }
  return true;
}

void CommandLine::check_commands(const std::vector<std::string>& arguments) const {
  const CLI::App* line = app_.get();
  std::string command = name();
  for (const std::string& word : arguments) {
    std::vector<std::string> known;
    for (const CLI::App* below : line->get_subcommands(nullptr)) known.push_back(below->get_name());
    if (known.empty() || word.starts_with('-')) return;
    const std::vector<const CLI::Option*> options = line->get_options();
    const bool takes_words =
        std::any_of(options.begin(), options.end(), [](const CLI::Option* option) { return option->get_positional(); });
    if (takes_words && !line->get_allow_extras() && std::find(known.begin(), known.end(), word) == known.end()) return;
    if (std::find(known.begin(), known.end(), word) == known.end())
      throw InputError({name(), 0, 0},
                       "unknown command '" + word + "'" + guess_of(word, known) + "; see " + command + " --help");
    line = line->get_subcommand(word);
    command += " " + word;
  }
}

std::string CommandLine::error_text(const std::vector<std::string>& arguments, const std::string& what) const {
  std::vector<const CLI::App*> lines = {app_.get()};
  std::string command = name();
  while (!lines.back()->get_subcommands().empty()) {
    lines.push_back(lines.back()->get_subcommands().front());
    command += " " + lines.back()->get_name();
  }
  const std::string unknown = unknown_option(lines, arguments);
  const std::string help = "; see " + command + " --help";
  if (!unknown.empty()) return unknown + help;
  if (lines.size() > 1) return what + help;
  if (arguments.empty()) return "name a command" + help;
  std::vector<std::string> commands;
  for (const CLI::App* line : app_->get_subcommands(nullptr)) commands.push_back(line->get_name());
  return "unknown command '" + arguments.front() + "'" + guess_of(arguments.front(), commands) + help;
}

bool CommandLine::asked() const { return app_->parsed(); }

namespace {

OptionHelp option_help(const CLI::Option& option) {
  OptionHelp help;
  help.positional = !option.nonpositional();
  if (help.positional) help.names = {option.get_name(true)};
  for (const std::string& name : option.get_snames()) help.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) help.names.push_back("--" + name);
  if (option.get_items_expected_max() > 0) help.value = option.get_type_name();
  help.doc = option.get_description();
  help.many = option.get_items_expected_max() > 1;
  return help;
}

CommandHelp command_help(const CLI::App& line, const std::string& above) {
  CommandHelp help;
  help.command = above.empty() ? line.get_name() : above + " " + line.get_name();
  help.text = line.help(above);
  help.summary = line.get_description();
  const std::string usage = "\nUsage: " + help.command + " ";
  if (const std::size_t at = help.text.find(usage); at != std::string::npos) {
    const std::size_t begin = at + usage.size();
    help.usage = help.text.substr(begin, help.text.find('\n', begin) - begin);
  }
  for (const CLI::Option* option : line.get_options())
    if (!option->get_group().empty()) help.options.push_back(option_help(*option));
  for (const CLI::App* command : line.get_subcommands([](const CLI::App*) { return true; }))
    help.commands.push_back(command->get_name());
  help.footer = line.get_footer();
  return help;
}

void add_help(const CLI::App& line, const std::string& above, std::vector<CommandHelp>& help) {
  help.push_back(command_help(line, above));
  const std::string name = help.back().command;
  for (const CLI::App* command : line.get_subcommands([](const CLI::App*) { return true; }))
    add_help(*command, name, help);
}

}  // namespace

std::vector<CommandHelp> CommandLine::help() const {
  std::vector<CommandHelp> help;
  add_help(*app_, "", help);
  return help;
}

std::string CommandLine::name() const { return app_->get_name(); }

}  // namespace plumbline::scenarios
