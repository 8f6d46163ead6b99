// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Manual pages and shell completion, as the programs write them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <sstream>

#include "support/paths.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::test_manual {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Manual : public ::testing::Test {
 protected:
  std::string read(const std::string& name) const {
    std::ifstream stream(folder.path(name), std::ios::binary);
    std::stringstream text;
    text << stream.rdbuf();
    return text.str();
  }
  /// Exit code; what the command prints is in the file `out`.
  int run(const std::string& command) const {
    const int status = std::system((command + " >" + folder.path("out") + " 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  bool installed(const std::string& program) const { return run("command -v " + program) == 0; }

  testing::ScratchFolder folder;
  const std::string egocal = paths::bin_dir() + "/egocal";
};

TEST_F(Manual, HasAPageForEveryCommandWithEveryOption) {
  ASSERT_EQ(run(egocal + " --manual " + folder.path("") + " 1.2.3"), 0) << read("out");
  const std::string solve = read("egocal-solve.1");
  EXPECT_THAT(solve, HasSubstr(".TH \"EGOCAL-SOLVE\" 1 \"\" \"egocal 1.2.3\""));
  ASSERT_EQ(run(egocal + " solve --help"), 0);
  std::istringstream help(read("out"));
  int options = 0;
  for (std::string line; std::getline(help, line);) {
    const std::size_t at = line.find("--");
    if (line.rfind("  -", 0) != 0 || at == std::string::npos) continue;
    std::string name = line.substr(at + 2, line.find_first_of(" ", at) - at - 2), escaped = "\\-\\-";
    for (const char c : name) escaped += c == '-' ? std::string("\\-") : std::string(1, c);
    EXPECT_THAT(solve, HasSubstr(escaped + "\\fR")) << line;
    ++options;
  }
  EXPECT_GT(options, 20);
  EXPECT_THAT(read("egocal.1"), HasSubstr("egocal\\-log\\fR(1)"));
  EXPECT_THAT(read("egocal-log-create.1"), HasSubstr("\\fIRIG\\fR"));
  if (!installed("man")) GTEST_SKIP() << "man is not installed: whether it warns is not known";
  EXPECT_EQ(run("(man --warnings -E UTF-8 -l -Tutf8 " + folder.path("egocal-solve.1") + " >/dev/null)"), 0);
  EXPECT_EQ(read("out"), "") << "man warns";
}

TEST_F(Manual, BashCompletesCommandsOptionsAndValues) {
  ASSERT_EQ(run(egocal + " --completion bash"), 0);
  std::ofstream(folder.path("script")) << read("out")
                                       << "try() { COMP_WORDS=(\"$@\"); COMP_CWORD=$(($# - 1)); _egocal; "
                                          "echo \"${COMPREPLY[*]}\"; }\n"
                                          "try egocal so\ntry egocal log c\ntry egocal solve a b --meth\n"
                                          "try egocal solve a b --method s\ntry egocal solve a\n";
  ASSERT_EQ(run("bash " + folder.path("script")), 0) << read("out");
  EXPECT_EQ(read("out"), "solve\ncreate check\n--method\nsdp sqp slsqp\n\n");
}

TEST_F(Manual, FishAndZshTakeTheirScripts) {
  for (const char* shell : {"fish", "zsh"}) {
    ASSERT_EQ(run(egocal + " --completion " + shell), 0);
    std::ofstream(folder.path(shell)) << read("out");
    if (installed(shell)) {
      EXPECT_EQ(run(std::string(shell) + " -n " + folder.path(shell)), 0) << read("out");
    }
  }
  if (!installed("fish") || !installed("zsh")) GTEST_SKIP() << "fish and zsh are not both installed";
  ASSERT_EQ(run("fish -c \"source " + folder.path("fish") + "; complete -C 'egocal solve --method sq'\""), 0);
  EXPECT_THAT(read("out"), HasSubstr("sqp\t"));
  EXPECT_THAT(read("out"), Not(HasSubstr("dual")));
}

TEST_F(Manual, AnotherShellIsWrongUsage) {
  EXPECT_EQ(run(egocal + " --completion csh"), 2);
  EXPECT_EQ(read("out"), "egocal: --completion: expected bash, zsh or fish, got 'csh'\n");
  EXPECT_EQ(run(egocal + " --manual " + folder.path("missing") + " 1"), 1);
}

TEST_F(Manual, EveryProgramHasOne) {
  for (const char* program : {"egocal-diagnosis", "egocal-fast", "egocal-global", "egocal-monitor",
                              "egocal-pairing", "egocal-player"}) {
    ASSERT_EQ(run(paths::bin_dir() + "/" + program + " --manual " + folder.path("") + " 1"), 0) << program;
    EXPECT_THAT(read(std::string(program) + ".1"), HasSubstr("\\-\\-rig\\fR")) << program;
  }
}

}  // namespace
}  // namespace egocal::test_manual
