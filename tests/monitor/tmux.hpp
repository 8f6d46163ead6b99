// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/wait.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include "support/scratch_folder.hpp"

namespace egocal::test {

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::stringstream text;
  text << stream.rdbuf();
  return text.str();
}

struct Output {
  std::string text;  ///< standard output
  int status = -1;   ///< exit code; 128 + the signal that ended it
};
inline Output output_of(const std::string& shell_command) {
  Output output;
  std::FILE* pipe = popen(shell_command.c_str(), "r");
  if (!pipe) throw std::runtime_error("popen failed");
  char buffer[4096];
  for (std::size_t n = 0; (n = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;)
    output.text.append(buffer, n);
  const int status = pclose(pipe);
  output.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  return output;
}

/// Waits for a condition, generously: a loaded machine is slow, not wrong.
inline bool until(const std::function<bool()>& condition,
                  std::chrono::milliseconds limit = std::chrono::seconds(30)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

/// Blanks at the ends of lines and empty lines at the end carry no meaning.
inline std::string trimmed(const std::string& text) {
  std::istringstream lines(text);
  std::string result, line;
  while (std::getline(lines, line)) {
    line.erase(line.find_last_not_of(' ') + 1);
    result += line + '\n';
  }
  while (result.size() > 1 && result.ends_with("\n\n")) result.pop_back();
  return result == "\n" ? "" : result;
}

/// A terminal of tmux's, with a shell script running in it, on a server of its own.
class Tmux {
 public:
  Tmux(int width, int height, const std::string& script) {
    static int count = 0;
    base_ = "env -u TMUX TMUX_TMPDIR=" + folder().string() + " LC_ALL=C.UTF-8 tmux -L t" +
            std::to_string(++count) + " -f " + (folder() / "conf").string() + " ";
    std::ofstream(folder() / "conf") << "set -g status off\nset -g remain-on-exit on\nset -s escape-time 0\n";
    std::ofstream(folder() / "script") << "cd " << folder().string() << "\nulimit -c 0\n" << script << "\n";
    const Output started = output_of(base_ + "new-session -d -s s -x " + std::to_string(width) + " -y " +
                                     std::to_string(height) + " sh " + (folder() / "script").string());
    if (started.status != 0) throw std::runtime_error("tmux does not start");
  }
  ~Tmux() { static_cast<void>(std::system((base_ + "kill-server 2>/dev/null").c_str())); }
  Tmux(const Tmux&) = delete;
  Tmux& operator=(const Tmux&) = delete;

  const std::filesystem::path& folder() const { return scratch_.path(); }
  std::string run(const std::string& command) const { return output_of(base_ + command).text; }
  /// The text on the screen.
  std::string screen() const { return trimmed(run("capture-pane -p -t s")); }
  /// The same with its colours, as escape sequences.
  std::string coloured_screen() const { return run("capture-pane -p -e -t s"); }
  /// In tmux's words: "a", "Enter", "C-z".
  void keys(const std::string& names) const { run("send-keys -t s " + names); }
  void type(const std::string& line) const {
    run("send-keys -t s -l '" + line + "'");
    keys("Enter");
  }
  void resize(int width, int height) const {
    run("resize-window -t s -x " + std::to_string(width) + " -y " + std::to_string(height));
  }
  std::string ask(const std::string& format) const {
    std::string answer = run("display-message -p -t s '" + format + "'");
    while (!answer.empty() && answer.back() == '\n') answer.pop_back();
    return answer;
  }
  bool cursor_visible() const { return ask("#{cursor_flag}") == "1"; }
  bool alternate_screen() const { return ask("#{alternate_on}") == "1"; }
  bool shows(const std::string& text) const { return screen().find(text) != std::string::npos; }

 private:
  testing::ScratchFolder scratch_;
  std::string base_;
};

}  // namespace egocal::test
