// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// `egocal solve --samples`: the program itself on still poses.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "egocal/io/trajectory_file.hpp"
#include "egocal/io/whole_file.hpp"
#include "support/arm_samples.hpp"
#include "support/file_content.hpp"
#include "support/paths.hpp"
#include "support/scratch_folder.hpp"

namespace egocal::test_samples_command {
namespace {

using testing::content_of;

/// The largest difference of three numbers from a vector.
double furthest(const nlohmann::json& numbers, const Eigen::Vector3d& vector) {
  const auto values = numbers.get<std::vector<double>>();
  return values.size() == 3 ? (Eigen::Vector3d(values.data()) - vector).cwiseAbs().maxCoeff() : INFINITY;
}

class SamplesCommand : public ::testing::Test {
 protected:
  struct Result {
    int code = -1;
    std::string out, error;
  };
  Result solve(const std::string& arguments) {
    const std::string out = folder.path("out"), error = folder.path("err");
    const std::string command = paths::bin_dir() + "/egocal solve " + folder.path("hand.tum") + " " +
                                folder.path("eye.tum") + " " + arguments + " >" + out + " 2>" + error;
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content_of(out), content_of(error)};
  }
  /// Samples, one of them wrong; the eye's stamps a little late. to_hand: the camera beside the arm.
  testing::SimulatedSamples write(bool to_hand, std::size_t samples = 12, std::size_t wrong = 1) {
    testing::Random random(4);
    testing::ArmSamples what;
    what.samples = samples;
    what.wrong = wrong;
    testing::SimulatedSamples drawn = testing::simulate_arm(what, random);
    Trajectory hand, eye;
    for (std::size_t i = 0; i < drawn.samples.size(); ++i) {
      const auto time = static_cast<std::int64_t>(3'000'000 * i);
      const DualQuaternion& a = drawn.samples[i].a;
      hand.push_back({time, to_hand ? conjugate(a) : a});
      eye.push_back({time + 20'000, drawn.samples[i].b});
    }
    write_tum(folder.path("hand.tum"), hand);
    write_tum(folder.path("eye.tum"), eye);
    return drawn;
  }

  static std::string row(double seconds, const DualQuaternion& pose) {
    const Pose at = to_pose(pose);
    std::ostringstream text;
    text << std::setprecision(17) << seconds;
    for (const double value : {at.translation.x(), at.translation.y(), at.translation.z(), at.rotation.x(),
                               at.rotation.y(), at.rotation.z(), at.rotation.w()})
      text << ' ' << value;
    return text.str() + "\n";
  }

  testing::ScratchFolder folder;
};

TEST_F(SamplesCommand, GivesBothPosesAndTheWrongRow) {
  for (const bool to_hand : {false, true}) {
    const testing::SimulatedSamples drawn = write(to_hand);
    const Result result =
        solve(to_hand ? "--samples --json --eye-to-hand" : "--samples --json --eye-in-hand");
    ASSERT_EQ(result.code, 0) << result.error;
    const nlohmann::json json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["verdict"], "good") << json["reason"];
    EXPECT_EQ(json["samples"]["wrong"], nlohmann::json::array({1}));
    EXPECT_EQ(json["samples"]["setup"], to_hand ? "eye_to_hand" : "eye_in_hand");
    const Pose X = to_pose(drawn.X), Y = to_pose(drawn.Y);
    EXPECT_LT(furthest(json["translation"], X.translation), 5e-3);
    EXPECT_LT(furthest(json["samples"]["target"]["translation"], Y.translation), 5e-3);
    EXPECT_LT(json["samples"]["spread_mm"]["median"].get<double>(), 3);
  }
}

// a is the file of the hand, and its name was that of the frame: a URDF hung the camera on the hand.
TEST_F(SamplesCommand, BesideTheArmTheAnswerIsInTheBase) {
  write(true);
  const std::string text = solve("--samples --eye-to-hand").out;
  EXPECT_NE(text.find("T_a_b, pose of the camera in the base (p_base = T_a_b p_camera)"), std::string::npos);
  EXPECT_NE(text.find("in the frame of the base"), std::string::npos) << text;
  const std::string urdf = solve("--samples --eye-to-hand --format urdf").out;
  EXPECT_NE(urdf.find("<parent link=\"base\"/>"), std::string::npos) << urdf;
  EXPECT_NE(urdf.find("<child link=\"camera\"/>"), std::string::npos) << urdf;
  EXPECT_NE(
      solve("--samples --eye-to-hand --format urdf --frame-a world").out.find("<parent link=\"world\"/>"),
      std::string::npos);
}

TEST_F(SamplesCommand, NamesOneWrongRowInTheSingular) {
  write(false);
  EXPECT_NE(solve("--samples").out.find(", 1 wrong and not used: row 1\n"), std::string::npos);
}

// The page had four empty figures and nothing of target, spread, noise and wrong samples
TEST_F(SamplesCommand, AReportSaysOfSamplesWhatSolvePrints) {
  write(false);
  const std::string printed = solve("--samples").out, page_file = folder.path("page.html");
  const std::string command = paths::bin_dir() + "/egocal report " + folder.path("hand.tum") + " " +
                              folder.path("eye.tum") + " --samples --out " + page_file + " >/dev/null 2>&1";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string page = content_of(page_file);
  for (const std::string label : {"samples", "fit", "target"}) {
    const std::string begin = "\n" + label + std::string(14 - label.size(), ' ');
    const std::size_t at = printed.find(begin) + begin.size();
    const std::string value = printed.substr(at, printed.find('\n', at) - at);
    EXPECT_NE(page.find("<th>" + label + "</th><td>" + value + "</td>"), std::string::npos) << value;
  }
  EXPECT_NE(page.find("Position residuals of samples"), std::string::npos);
  EXPECT_NE(page.find("wrong, not used"), std::string::npos);
  for (const char* of_streams : {"residuals of motions", "0 of a", "time offset"})
    EXPECT_EQ(page.find(of_streams), std::string::npos) << of_streams;
}

// Rows were counted after those without a pose were skipped and the others sorted: another image was named
TEST_F(SamplesCommand, RowsAreThoseOfTheFile) {
  const testing::SimulatedSamples drawn = write(false, 12, 1);
  std::string hand = "# time x y z qx qy qz qw\n", eye = hand;
  for (std::size_t i = 12; i-- > 0;) {  // the first in time, which is wrong, is the last row
    hand += row(100 + 10.0 * static_cast<double>(i), drawn.samples[i].a);
    if (i == 9) hand += "\n# taken again\n95 0 0 0 0 0 0 0\n";
    if (i != 4) eye += row(100 + 10.0 * static_cast<double>(i), drawn.samples[i].b);
  }
  write_whole_file(folder.path("hand.tum"), hand);
  write_whole_file(folder.path("eye.tum"), eye);
  const nlohmann::json json = nlohmann::json::parse(solve("--samples --json").out);
  EXPECT_EQ(json["samples"]["wrong"], nlohmann::json::array({13}));
  EXPECT_EQ(json["samples"]["residuals"][0]["row"], 13);
  EXPECT_EQ(json["samples"]["residuals"][0]["row_b"], 11);
  EXPECT_EQ(json["samples"]["residuals"][10]["row"], 1);
  EXPECT_EQ(json["samples"]["residuals"][10]["row_b"], 1);
  const std::string text = solve("--samples").out;
  EXPECT_NE(text.find("samples       11, 1 wrong and not used: row 13 (11 of b)\n"), std::string::npos)
      << text;
  EXPECT_NE(text.find("1 of 11 samples contradict the others and do not count: row 13 (11 of b)."),
            std::string::npos)
      << text;
}

// A row without a pose moved all behind it to the next one of the other list
TEST_F(SamplesCommand, ARowWithoutAPoseKeepsItsPlace) {
  const testing::SimulatedSamples drawn = write(false, 12, 0);
  std::string hand, eye;
  for (std::size_t i = 0; i < 12; ++i) {
    hand +=
        i == 7 ? "nan nan nan nan nan nan nan nan\n" : row(10.0 * static_cast<double>(i), drawn.samples[i].a);
    eye += i == 2 ? "nan nan nan nan nan nan nan nan\n"
                  : row(1e5 + static_cast<double>(i * i), drawn.samples[i].b);
  }
  write_whole_file(folder.path("hand.tum"), hand);
  write_whole_file(folder.path("eye.tum"), eye);
  const nlohmann::json json = nlohmann::json::parse(solve("--samples --json").out);
  EXPECT_EQ(json["samples"]["matched_by"], "row");
  EXPECT_EQ(json["samples"]["count"], 10);
  EXPECT_EQ(json["samples"]["without_partner"], 2);
  EXPECT_EQ(json["samples"]["wrong"], nlohmann::json::array());
  EXPECT_EQ(json["verdict"], "good");
}

// "give equally many rows": both files had twelve
TEST_F(SamplesCommand, EqualStampsAreMatchedByRow) {
  const testing::SimulatedSamples drawn = write(false, 12, 0);
  for (const double step : {0.0, 0.5}) {  // all alike, and two each of whole seconds
    std::string hand, eye;
    for (std::size_t i = 0; i < 12; ++i) {
      hand += row(std::floor(step * static_cast<double>(i)), drawn.samples[i].a);
      eye += row(std::floor(step * static_cast<double>(i)), drawn.samples[i].b);
    }
    write_whole_file(folder.path("hand.tum"), hand);
    write_whole_file(folder.path("eye.tum"), eye);
    const Result result = solve("--samples --json");
    ASSERT_EQ(result.code, 0) << result.error;
    const nlohmann::json json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["samples"]["count"], 12);
    EXPECT_EQ(json["samples"]["matched_by"], "row");
    EXPECT_NE(result.error.find("stamps are equal: row i of a belongs to row i of b\n"), std::string::npos)
        << result.error;
  }
}

// From 10 s between poses on one file was read as seconds, the other one as milliseconds
TEST_F(SamplesCommand, TimesOfBothFilesAreReadInOneUnit) {
  const testing::SimulatedSamples drawn = write(false, 20, 0);
  for (const double first : {0.0, 1.7e9}) {
    std::string hand, eye;
    for (std::size_t i = 0; i < 20; ++i) {
      const double time = first + 9.5 * static_cast<double>(i);
      hand += row(time, drawn.samples[i].a);
      if (i < 5 || i % 2 == 0) eye += row(time, drawn.samples[i].b);
    }
    write_whole_file(folder.path("hand.tum"), hand);
    write_whole_file(folder.path("eye.tum"), eye);
    const Result result = solve("--samples --json");
    ASSERT_EQ(result.code, 0) << first << ": " << result.error;
    const nlohmann::json json = nlohmann::json::parse(result.out);
    EXPECT_EQ(json["samples"]["count"], 12) << first;
    EXPECT_EQ(json["samples"]["matched_by"], "stamp") << first;
  }
}

TEST_F(SamplesCommand, TheCureOfEyeToHandIsToLeaveItOut) {
  write(false, 60);
  const Result result = solve("--samples --json --eye-to-hand");
  std::string cures;
  const nlohmann::json json = nlohmann::json::parse(result.out);
  for (const auto& finding : json["findings"]) cures += finding["remedy"].get<std::string>() + "\n";
  EXPECT_NE(cures.find("leave out --eye-to-hand"), std::string::npos) << result.out;
  EXPECT_EQ(cures.find("hand."), std::string::npos) << "not to be copied: " << result.out;
}

TEST_F(SamplesCommand, SixInvertedRowsAreNoAnswer) {
  write(false, 6, 0);
  const Result result = solve("--samples --json --invert-b");
  EXPECT_EQ(result.code, 3) << result.error;
  EXPECT_NE(result.out.find("\"inverted_b\""), std::string::npos) << result.out;
}

TEST_F(SamplesCommand, OneRowSixTimesShowsNothing) {
  const testing::SimulatedSamples drawn = write(false, 1, 0);
  Trajectory hand, eye;
  for (std::int64_t i = 0; i < 6; ++i) {
    hand.push_back({3'000'000 * i, drawn.samples[0].a});
    eye.push_back({3'000'000 * i, drawn.samples[0].b});
  }
  write_tum(folder.path("hand.tum"), hand);
  write_tum(folder.path("eye.tum"), eye);
  const Result result = solve("--samples --json");
  const nlohmann::json json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json["verdict"], "incomplete");
  EXPECT_EQ(json["observable"], nlohmann::json(std::vector<bool>(6, false)));
  EXPECT_EQ(json["findings"][0]["code"], "too_little_motion");
}

TEST_F(SamplesCommand, IsOfferedWhereFilesLookLikeSamples) {
  write(false);
  const Result result = solve("--max-gap 10");
  EXPECT_NE(result.error.find("--samples"), std::string::npos) << result.error;
}

TEST_F(SamplesCommand, RefusesWhatOnlyStreamsHave) {
  write(false);
  for (const char* option :
       {"--samples --stride 2", "--samples --time-offset auto", "--samples --weights equal",
        "--samples --method local", "--samples --eye-in-hand --eye-to-hand", "--eye-to-hand",
        "--samples --scale-b auto"}) {
    const Result result = solve(option);
    EXPECT_EQ(result.code, 2) << option;
    EXPECT_TRUE(result.out.empty()) << option;
    EXPECT_EQ(std::count(result.error.begin(), result.error.end(), '\n'), 1)
        << option << ": " << result.error;
  }
}

}  // namespace
}  // namespace egocal::test_samples_command
