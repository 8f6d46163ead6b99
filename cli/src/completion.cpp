// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "completion.hpp"

namespace egocal::cli {

namespace {

/// Between single quotes of bash and zsh.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

/// Between single quotes of fish.
std::string fish_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += (c == '\'' || c == '\\') ? std::string("\\") + c : std::string(1, c);
  return out + "'";
}

/// "name:help" for zsh's _describe, where a colon ends the name.
std::string described(const std::string& name, const std::string& help) {
  std::string escaped;
  for (const char c : name) escaped += c == ':' ? std::string("\\:") : std::string(1, c);
  return quoted(escaped + ":" + help);
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// A function's name: letters, digits and underscores.
std::string identifier(const std::string& program) {
  std::string name = "_";
  for (const char c : program) name += c == '-' ? '_' : c;
  return name;
}

/// The patterns of a `case` on "COMMAND WORD" that lead to a command below.
std::string paths_below(const CommandDescription& program, const char* quote, const char* between) {
  std::string text;
  for (const CommandDescription* command : all_commands(program)) {
    if (command == &program) continue;
    text += (text.empty() ? "" : between) + (quote + command->path + quote);
  }
  return text;
}

std::vector<std::string> option_names(const CommandDescription& command) {
  std::vector<std::string> names;
  for (const OptionDescription& option : command.options)
    if (!option.positional) names.push_back(option.name);
  return names;
}

/// `--method) values=...;;` for each option with a set of values.
std::string value_cases(const CommandDescription& command, bool zsh) {
  std::string text;
  for (const OptionDescription& option : command.options) {
    if (option.positional || option.choices.empty()) continue;
    const std::string choices = joined(option.choices);
    text += "        " + option.name + ") values=" + (zsh ? "(" + choices + ")" : quoted(choices)) + " ;;\n";
  }
  return text;
}

}  // namespace

std::string bash_completion(const CommandDescription& program) {
  const std::string function = identifier(program.path);
  std::string text = "# bash completion of " + program.path + "; written by " + program.path +
                     " --completion bash\n" + function +
                     "() {\n"
                     "  local word=\"${COMP_WORDS[COMP_CWORD]}\" before=\"${COMP_WORDS[COMP_CWORD-1]}\" at=" +
                     program.path + " i options= values= commands=\n";
  if (!program.commands.empty())
    text += "  for ((i = 1; i < COMP_CWORD; ++i)); do\n    case \"$at ${COMP_WORDS[i]}\" in\n      " +
            paths_below(program, "\"", "|") + ") at=\"$at ${COMP_WORDS[i]}\" ;;\n    esac\n  done\n";
  text += "  case \"$at\" in\n";
  for (const CommandDescription* command : all_commands(program)) {
    std::vector<std::string> below;
    for (const CommandDescription& next : command->commands) below.push_back(last_word(next.path));
    text += "    \"" + command->path + "\")\n      options=" + quoted(joined(option_names(*command))) +
            " commands=" + quoted(joined(below)) + "\n";
    const std::string cases = value_cases(*command, false);
    if (!cases.empty()) text += "      case \"$before\" in\n" + cases + "      esac\n";
    text += "      ;;\n";
  }
  return text +
         "  esac\n"
         "  COMPREPLY=()\n"
         "  if [[ -n $values ]]; then COMPREPLY=($(compgen -W \"$values\" -- \"$word\"))\n"
         "  elif [[ $word == -* ]]; then COMPREPLY=($(compgen -W \"$options\" -- \"$word\"))\n"
         "  elif [[ -n $commands ]]; then COMPREPLY=($(compgen -W \"$commands\" -- \"$word\"))\n"
         "  fi\n"
         "}\n"
         "complete -o default -o bashdefault -F " +
         function + " " + program.path + "\n";
}

std::string zsh_completion(const CommandDescription& program) {
  std::string text = "#compdef " + program.path + "\n# written by " + program.path +
                     " --completion zsh\n"
                     "local at=" +
                     program.path + " i\nlocal -a options commands values\n";
  if (!program.commands.empty())
    text += "for ((i = 2; i < CURRENT; ++i)); do\n  case \"$at $words[i]\" in\n    " +
            paths_below(program, "\"", "|") + ") at=\"$at $words[i]\" ;;\n  esac\ndone\n";
  text += "case \"$at\" in\n";
  for (const CommandDescription* command : all_commands(program)) {
    text += "  \"" + command->path + "\")\n    options=(";
    for (const OptionDescription& option : command->options)
      if (!option.positional) text += "\n      " + described(option.name, option.help);
    text += ")\n    commands=(";
    for (const CommandDescription& below : command->commands)
      text += "\n      " + described(last_word(below.path), below.help);
    text += ")\n";
    const std::string cases = value_cases(*command, true);
    if (!cases.empty()) text += "    case \"$words[CURRENT-1]\" in\n" + cases + "    esac\n";
    text += "    ;;\n";
  }
  return text +
         "esac\n"
         "if (( $#values )); then compadd -a values\n"
         "elif [[ $words[CURRENT] == -* ]]; then _describe -o option options\n"
         "elif (( $#commands )); then _describe command commands\n"
         "else _files\n"
         "fi\n";
}

std::string fish_completion(const CommandDescription& program) {
  const std::string function = "_" + identifier(program.path) + "_at";
  std::string text = "# fish completion of " + program.path + "; written by " + program.path +
                     " --completion fish\nfunction " + function + "\n  set -l at " + program.path + "\n";
  if (!program.commands.empty())
    text += "  for word in (commandline -opc)[2..]\n    switch \"$at $word\"\n      case " +
            paths_below(program, "'", " ") + "\n        set at \"$at $word\"\n    end\n  end\n";
  text += "  test \"$at\" = \"$argv[1]\"\nend\n";
  const std::string complete = "complete -c " + program.path;
  for (const CommandDescription* command : all_commands(program)) {
    const std::string here = complete + " -n " + fish_quoted(function + " \"" + command->path + "\"");
    for (const CommandDescription& below : command->commands)
      text += here + " -f -a " + last_word(below.path) + " -d " + fish_quoted(below.help) + "\n";
    for (const OptionDescription& option : command->options) {
      if (option.positional) continue;
      text += here + " -l " + option.name.substr(2);
      if (!option.choices.empty()) text += " -x -a " + fish_quoted(joined(option.choices));
      if (option.choices.empty() && !option.value.empty()) text += " -r";
      text += " -d " + fish_quoted(option.help) + "\n";
    }
  }
  return text;
}

}  // namespace egocal::cli
