// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "manual.hpp"

#include <algorithm>
#include <cctype>

namespace egocal::cli {

namespace {

/// Text for roff: backslashes and hyphens escaped, no line that begins with a control character.
std::string roff(const std::string& text) {
  std::string out;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) out += "\\&";
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
    line_begins = c == '\n';
  }
  return out;
}

std::string page_name(const CommandDescription& command) {
  std::string name = command.path;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

/// The sentence of a help text: "what a recording holds" becomes "What a recording holds."
std::string sentence(std::string text) {
  if (text.empty()) return text;
  text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  if (text.back() != '.') text += '.';
  return text;
}

std::string synopsis(const CommandDescription& command) {
  std::string text = "\\fB" + roff(command.path) + "\\fR [\\fIOPTIONS\\fR]";
  for (const OptionDescription& option : command.options)
    if (option.positional)
      text += option.required ? " \\fI" + option.name + "\\fR" : " [\\fI" + option.name + "\\fR]";
  if (!command.commands.empty()) text += " \\fICOMMAND\\fR";
  return text + "\n";
}

std::string option_text(const OptionDescription& option) {
  std::string text = ".TP\n\\fB" + roff(option.name) + "\\fR";
  if (!option.value.empty() && !option.positional) text += " \\fI" + roff(option.value) + "\\fR";
  text += "\n" + roff(sentence(option.help));
  if (option.help.empty()) text += "\\&";
  if (!option.choices.empty()) {
    text += "\nOne of";
    for (const std::string& choice : option.choices) text += " \\fB" + roff(choice) + "\\fR";
    text += ".";
  }
  return text + (option.required ? "\nRequired.\n" : "\n");
}

std::string option_section(const CommandDescription& command, bool positional, const char* title) {
  std::string text;
  for (const OptionDescription& option : command.options)
    if (option.positional == positional) text += option_text(option);
  return text.empty() ? "" : std::string(".SH ") + title + "\n" + text;
}

}  // namespace

std::string manual_file(const CommandDescription& command) {
  return page_name(command) + ".1";
}

std::string manual_page(const CommandDescription& command, const std::string& version) {
  const std::string program = command.path.substr(0, command.path.find(' '));
  std::string title = page_name(command);
  for (char& c : title) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string help = command.help;
  if (help.rfind(program + ": ", 0) == 0) help.erase(0, program.size() + 2);
  std::string text = ".TH \"" + title + "\" 1 \"\" \"" + program + " " + version + "\" \"User Commands\"\n";
  text += ".SH NAME\n" + roff(page_name(command) + " - " + help) + "\n";
  text += ".SH SYNOPSIS\n" + synopsis(command);
  text += ".SH DESCRIPTION\n" + roff(sentence(help)) + "\n";
  text += option_section(command, true, "ARGUMENTS") + option_section(command, false, "OPTIONS");
  if (!command.commands.empty()) {
    text += ".SH COMMANDS\n";
    for (const CommandDescription& below : command.commands)
      text += ".TP\n\\fB" + roff(last_word(below.path)) + "\\fR\n" + roff(sentence(below.help)) +
              " See \\fB" + roff(page_name(below)) + "\\fR(1).\n";
  }
  if (!command.footer.empty()) text += ".SH NOTES\n" + roff(command.footer) + "\n";
  if (command.path != program) text += ".SH SEE ALSO\n\\fB" + roff(program) + "\\fR(1)\n";
  return text;
}

}  // namespace egocal::cli
