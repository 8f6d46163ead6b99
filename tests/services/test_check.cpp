// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/bus/check.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "pairing/pairing.hpp"
#include "program/program.hpp"
#include "support/file_content.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::services::test_check {
namespace {

const char* const rig_text =
    "[[sensor]]\nname = \"a\"\nchannel = \"A\"\n[[sensor]]\nname = \"b\"\nchannel = \"B\"\n"
    "[[pair]]\na = \"a\"\nb = \"b\"\n";

TEST(Check, what_holds_costs_nothing_and_what_does_not_is_named_with_its_place) {
  int evaluated = 0;
  EGOCAL_CHECK(++evaluated == 1, "it is evaluated once");
  EXPECT_EQ(evaluated, 1);
  try {
    EGOCAL_CHECK(evaluated == 2, "two is one");
    FAIL() << "nothing was thrown";
  } catch (const std::logic_error& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("two is one (test_check.cpp:"), std::string::npos) << text;
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

TEST(Check, a_program_reports_one_line_and_ends_with_1_so_that_it_is_started_again) {
  const testing::ScratchFolder scratch;
  std::string arguments[] = {"egocal-any", "--rig", scratch.file("rig.toml", rig_text), "--lcm-url",
                             "memq://"};
  char* argv[5];
  std::transform(std::begin(arguments), std::end(arguments), argv,
                 [](std::string& text) { return text.data(); });
  const ProgramDescription description{"egocal-any", bus::Role::fast, "1.0", "Contradicts itself.", {}, {}};
  ::testing::internal::CaptureStderr();
  const int code = run_program(5, argv, description, [](auto&, auto&, const auto&) -> std::shared_ptr<void> {
    bus::contradiction("all is well", "any.cpp", 7);
  });
  const std::string printed = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(code, 1);
  EXPECT_EQ(std::count(printed.begin(), printed.end(), '\n'), 1) << printed;
  EXPECT_EQ(printed.find("egocal-any: a defect in this program"), 0U) << printed;
}

TEST(Check, pairing_that_contradicts_itself_keeps_the_state_that_was_saved_before) {
  const testing::ScratchFolder scratch;
  const std::string file = scratch.path("pairing.state");
  const bus::Rig rig = bus::parse_rig(rig_text, "rig.toml");
  std::string before;
  const auto live = [&](bool contradicts) {
    bus::Loop loop("memq://");
    bus::Heartbeat heartbeat(loop, {"egocal-pairing", bus::Role::pairing, "1.0"}, std::chrono::seconds(1));
    const Pairing pairing(loop, heartbeat, rig, std::make_unique<SavedState>(file, rig));
    before = testing::content_of(file);
    if (contradicts) bus::contradiction("all is well", "any.cpp", 7);
  };
  EXPECT_THROW(live(true), std::logic_error);
  EXPECT_EQ(testing::content_of(file), before);
  live(false);  // a last snapshot, of another time
  EXPECT_NE(testing::content_of(file), before);
}

}  // namespace
}  // namespace egocal::services::test_check
