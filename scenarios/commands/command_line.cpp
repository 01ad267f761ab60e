// SPDX-License-Identifier: Apache-2.0
#include "scenarios/commands/command_line.h"

#include <CLI/CLI.hpp>

#include "bim/errors.h"

namespace plumbline::scenarios {

Argument& Argument::required() {
  option_->required();
  return *this;
}

Argument& Argument::range(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Argument& Argument::range(double least, double most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Argument& Argument::positive() {
  option_->check(CLI::PositiveNumber);
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

Argument& Argument::hidden() {
  option_->group("");
  return *this;
}

bool Argument::given() const { return option_->count() > 0; }

CommandLine::CommandLine(const std::string& summary, const std::string& name)
    : app_(std::make_shared<CLI::App>(summary, name)) {}

CommandLine CommandLine::add_command(const std::string& name, const std::string& summary) {
  return CommandLine(std::shared_ptr<CLI::App>(app_, app_->add_subcommand(name, summary)));
}

template <class T>
Argument CommandLine::add(const std::string& name, T& value, const std::string& doc) {
  return Argument(app_->add_option(name, value, doc));
}

Argument CommandLine::option(const std::string& name, std::string& value, const std::string& doc) {
  return add(name, value, doc);
}

Argument CommandLine::option(const std::string& name, std::vector<std::string>& value, const std::string& doc) {
  return add(name, value, doc);
}

Argument CommandLine::option(const std::string& name, int& value, const std::string& doc) {
  return add(name, value, doc);
}

Argument CommandLine::option(const std::string& name, std::uint64_t& value, const std::string& doc) {
  return add(name, value, doc);
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

void CommandLine::takes_command_or_any() {
  app_->require_subcommand(0, 1);
  app_->allow_extras();
}

bool CommandLine::parse(const std::vector<std::string>& arguments) {
  try {
    app_->parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // the last stands first there
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app_->exit(error) != 0;  // --help, --version
    throw InputError({name(), 0, 0}, std::string(error.what()) + "; see " + name() + " --help");
  }
  return true;
}

bool CommandLine::asked() const { return app_->parsed(); }

std::string CommandLine::name() const { return app_->get_name(); }

}  // namespace plumbline::scenarios
