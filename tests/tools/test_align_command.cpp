// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal align`: one stream laid over another.
#include <gtest/gtest.h>

#include <string>

#include "rig_command.hpp"

namespace egocal::test_align_command {
namespace {

using AlignCommand = testing::RigCommand;

// The drift that was found was left in the times written: 60 ms at the end, and the stream that was laid over
// a contradicted it.
TEST_F(AlignCommand, ADriftOfTheClockIsTakenOut) {
  const std::string drive = folder.path("drive"), out = folder.path("b.tum");
  ASSERT_EQ(run("simulate --poses 1200 --roughness 0.3 --noise 0.005 --clock-offset camera=0.2 --clock-drift "
                "camera=0.0005 --out " +
                drive)
                .code,
            0);
  const std::string a = " " + drive + "/lidar.tum ";
  const Result aligned = run("align" + a + drive + "/camera.tum --time-offset auto --out " + out);
  ASSERT_EQ(aligned.code, 0) << aligned.error;
  EXPECT_NE(aligned.out.find("clock drift"), std::string::npos) << aligned.out;
  const nlohmann::json again = run("solve --json" + a + out).object();
  EXPECT_EQ(again["verdict"], "good") << again["reason"];
  EXPECT_TRUE(again["findings"].empty()) << again["findings"];
}

}  // namespace
}  // namespace egocal::test_align_command
