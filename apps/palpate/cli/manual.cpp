// Writes the manual page and the completion for bash from the registered options.
#include "apps/palpate/cli/manual.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <vector>

namespace palpate::app {

namespace {

std::vector<CLI::App*> commands_of(CLI::App& command) {
  return command.get_subcommands([](const CLI::App*) { return true; });
}

// Options that help shows: a hidden one has no group.
std::vector<CLI::Option*> options_of(CLI::App& command) {
  return command.get_options([](const CLI::Option* each) { return !each->get_group().empty(); });
}

// Text as troff takes it: no line begins with a control character, and '-' can be copied and
// pasted.
std::string troff(const std::string& text) {
  std::string result;
  bool begins = true;
  for (const char c : text) {
    if (begins && (c == '.' || c == '\'')) result += "\\&";
    if (c == '\\') {
      result += "\\e";
    } else if (c == '-') {
      result += "\\-";
    } else {
      result += c;
    }
    begins = c == '\n';
  }
  return result;
}

std::string manual_of(const CLI::Option& option) {
  const bool positional = option.get_positional();
  const std::string value = option.get_type_name();
  return fmt::format(".TP\n.B {}{}\n{}\n", troff(option.get_name(positional, true)),
                     value.empty() ? "" : " \\fI" + troff(value) + "\\fR",
                     troff(option.get_description()));
}

std::string manual_of(CLI::App& command, const std::string& name) {
  std::string text = fmt::format(".SS {}\n{}\n", troff(name), troff(command.get_description()));
  std::string group;
  for (const CLI::Option* option : options_of(command)) {
    if (option->get_group() != group) {
      group = option->get_group();
      text += fmt::format(".PP\n{}\n", troff(group));
    }
    text += manual_of(*option);
  }
  const std::string footer = command.get_footer();
  if (!footer.empty()) text += fmt::format(".PP\n.nf\n{}\n.fi\n", troff(footer));
  for (CLI::App* each : commands_of(command))
    text += manual_of(*each, name + ' ' + each->get_name());
  return text;
}

// Words that may follow a command, as "touch --radius --voxel".
std::string words_of(CLI::App& command) {
  std::string words;
  for (const CLI::Option* option : options_of(command)) {
    for (const std::string& name : option->get_lnames()) words += " --" + name;
  }
  for (CLI::App* each : commands_of(command)) {
    words += ' ' + each->get_name() + words_of(*each);
  }
  return words;
}

// The names that an option takes, with ' ' between; empty: it takes others.
std::string names_for(CLI::Option& option) {
  try {
    return option.get_validator(0)->get_name();
  } catch (const CLI::OptionNotFound&) {
    return "";
  }
}

std::string cases_of(CLI::App& command, const std::string& name) {
  std::string cases;
  for (CLI::Option* option : options_of(command)) {
    const std::string names = names_for(*option);
    if (names.empty()) continue;
    cases += fmt::format("    '{} {}') words='{}' ;;\n", name, option->get_name(), names);
  }
  for (CLI::App* each : commands_of(command)) cases += cases_of(*each, name);
  return cases;
}

}  // namespace

std::string manual_page(CLI::App& program) {
  const std::string version = program.version();  // and below it how it was built
  std::string text = fmt::format(
      ".TH PALPATE 1 \"\" \"{}\"\n.SH NAME\npalpate \\- feel a point cloud\n"
      ".SH SYNOPSIS\n.B palpate\n.I COMMAND\n[\\fIOPTIONS\\fR]\n.SH DESCRIPTION\n{}\n"
      ".SH COMMANDS\n",
      version.substr(0, version.find('\n')), troff(program.get_description()));
  for (CLI::App* each : commands_of(program)) text += manual_of(*each, each->get_name());
  return text +
         ".SH EXIT STATUS\n.TP\n.B 0\nThe command did what it was asked to do.\n"
         ".TP\n.B 1\nThe input was bad or the run failed; the message says why.\n"
         ".TP\n.B 2\nThe command line makes no sense.\n"
         ".SH FILES\nPages that messages name as docs/... lie where\n.B palpate "
         "\\-\\-version\nsays.\n";
}

std::string bash_completion(CLI::App& program) {
  std::string commands;
  std::string values;
  std::string options;
  for (CLI::App* each : commands_of(program)) {
    const std::string name = each->get_name();
    commands += ' ' + name;
    values += cases_of(*each, name);
    options += fmt::format("    {}) words='{}' ;;\n", name, words_of(*each));
  }
  return fmt::format(R"(# Completion of palpate's commands and options in bash.
_palpate() {{
  local words=
  if [ "$COMP_CWORD" -eq 1 ]; then
    words='--help --version{}'
  else
    case ${{COMP_WORDS[1]}} in
{}    esac
  fi
  case "${{COMP_WORDS[1]}} ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{}  esac
  mapfile -t COMPREPLY < <(compgen -W "$words" -- "${{COMP_WORDS[COMP_CWORD]}}")
}}
complete -o default -F _palpate palpate
)",
                     commands, options, values);
}

}  // namespace palpate::app
