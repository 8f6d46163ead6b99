// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>
#include <optional>

#include "../support/file_content.hpp"
#include "../support/paths.hpp"
#include "../support/random_motion.hpp"
#include "../support/scratch_folder.hpp"
#include "egocal/error.hpp"
#include "egocal/io/trajectory_file.hpp"
#include "egocal/simulation/simulation.hpp"
#include "experiments/comparison.hpp"
#include "experiments/figure.hpp"
#include "experiments/globality.hpp"
#include "experiments/online.hpp"
#include "experiments/paper.hpp"
#include "experiments/source.hpp"
#include "experiments/table_text.hpp"

namespace egocal::tools::test_experiments {
namespace {

using testing::content_of;
using ::testing::HasSubstr;

constexpr double degree = std::numbers::pi / 180;

DataSet random_data(egocal::testing::Motion motion, std::uint64_t pairs, double noise) {
  egocal::testing::Random random(5);
  DataSet data;
  data.truth = motion == egocal::testing::Motion::planar ? egocal::testing::random_planar_extrinsic(random)
                                                         : egocal::testing::random_extrinsic(random);
  data.pairs =
      egocal::testing::random_pairs(*data.truth, {.motion = motion, .pairs = pairs, .noise = noise}, random);
  for (std::size_t i = 0; i < data.pairs.size(); ++i) {
    data.pairs[i].begin_us = static_cast<std::int64_t>(i) * 100'000;
    data.pairs[i].end_us = data.pairs[i].begin_us + 100'000;
  }
  return data;
}

TEST(Compare, EveryMethodFindsTheExtrinsicOfAWellConditionedDrive) {
  const DataSet data = random_data(egocal::testing::Motion::free, 500, 0.01);
  const std::vector<ComparisonRow> rows = compare(data, 1);
  EXPECT_EQ(rows.size(), 7u);
  for (const ComparisonRow& row : rows) {
    ASSERT_TRUE(row.error);
    EXPECT_LT(row.error->rotation, 0.1 * degree) << row.method;
    EXPECT_LT(row.error->translation, 0.05) << row.method;
    EXPECT_GT(row.milliseconds, 0) << row.method;
    EXPECT_THAT(row.verdict, ::testing::AnyOf("certified", "valid")) << row.method;
  }
  EXPECT_THAT(table(rows), HasSubstr("analytic [19]"));
}

TEST(Compare, OurSolversAgreeAndTheAnalyticOneSaysThatItFailed) {
  const std::vector<ComparisonRow> rows =
      compare(random_data(egocal::testing::Motion::dominant_axis, 500, 0.05), 1);
  std::map<std::string, ComparisonRow> by_name;
  for (const ComparisonRow& row : rows) by_name[row.method] = row;
  const DualQuaternion dual = by_name.at("global (dual)").T_a_b;
  for (const char* name : {"global (sdp)", "fast (slsqp)", "fast (sqp)"}) {
    EXPECT_LT(extrinsic_error(dual, by_name.at(name).T_a_b).translation, 1e-8) << name;
    EXPECT_EQ(by_name.at(name).verdict, "certified") << name;
  }
  EXPECT_THAT(by_name.at("analytic [19]").verdict, HasSubstr("axes"));
  EXPECT_EQ(by_name.at("matrix [8]").verdict, "certified");
}

TEST(Compare, RunsThePlanarMethodsWhereTheGroundIsKnown) {
  DataSet data = random_data(egocal::testing::Motion::planar, 500, 0.02);
  data.plane_a = data.plane_b = GroundPlane{};
  const std::vector<ComparisonRow> rows = compare(data, 1);
  ASSERT_EQ(rows.size(), 9u);
  for (std::size_t i = 7; i < 9; ++i) {
    EXPECT_EQ(rows[i].mode, Mode::planar);
    EXPECT_LT(rows[i].error->rotation, 0.5 * degree);
    EXPECT_LT(rows[i].error->translation, 0.1);
    EXPECT_EQ(rows[i].verdict, "certified");
  }
}

TEST(Globality, TheGapGrowsWithTheErrorAndNothingFalsifiedIsCertified) {
  const DataSet data = random_data(egocal::testing::Motion::free, 400, 0.05);
  const std::vector<GlobalityPoint> points = globality_experiment(data, {});
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].certified, 0);
    EXPECT_EQ(points[i].disproved, points[i].runs);
    EXPECT_LE(points[i].excess_median, points[i].gap_median * (1 + 1e-6));
    if (i > 0 && points[i].rotation == points[i - 1].rotation && points[i].frames == points[i - 1].frames) {
      EXPECT_GT(points[i].gap_median, points[i - 1].gap_median);
    }
  }
}

TEST(Globality, TheGapDoesNotDependOnTheNumberOfFrames) {
  const DataSet data = random_data(egocal::testing::Motion::free, 4000, 0.05);
  GlobalityOptions options;
  options.rotations = {1};
  options.translations = {0.1};
  options.parts = {0.1, 1};
  const std::vector<GlobalityPoint> points = globality_experiment(data, options);
  ASSERT_EQ(points.size(), 4u);
  EXPECT_NEAR(points[0].gap_median / points[2].gap_median, 1, 0.3);
  EXPECT_NEAR(points[1].gap_median / points[3].gap_median, 1, 0.3);
}

TEST(Online, FallsBackOnTheGlobalSolverUntilTheFastOneIsVerified) {
  const DataSet data = random_data(egocal::testing::Motion::dominant_axis, 150, 0.02);
  double progress = 0;
  const std::vector<OnlinePoint> points =
      online_experiment(data, Mode::spatial, 120, {}, [&](double part) { progress = part; });
  ASSERT_EQ(points.size(), 120u);
  EXPECT_EQ(progress, 1);
  EXPECT_TRUE(points.front().global_used);
  EXPECT_FALSE(points.back().global_used);
  EXPECT_TRUE(points.back().fast_verified);
  for (const OnlinePoint& point : points) EXPECT_TRUE(point.certified) << point.frame;
  EXPECT_LT(points.back().error->rotation, points[2].error->rotation);
  EXPECT_NEAR(points.back().time, 12, 1e-9);
}

TEST(Figure, LeavesNumbersAndPictures) {
  const testing::ScratchFolder scratch;
  const std::string folder = scratch.path("its") + "/it's deep";
  const std::vector<GlobalityPoint> points{{.frames = 10, .rotation = true, .amount = 1, .gap_median = 0.5}};
  const std::vector<std::string> files = write_figure(folder, "gap", csv(points), panels(points));
  ASSERT_GE(files.size(), 3u);
  EXPECT_THAT(content_of(files[0]), HasSubstr("10,rotation,1,deg,0,0.5,"));
  EXPECT_THAT(files[1], ::testing::EndsWith("gap-rotation.svg"));
  EXPECT_THAT(content_of(files[1]), ::testing::StartsWith("<svg"));
  EXPECT_THAT(content_of(files[1]), HasSubstr("10 frames"));
}

TEST(Figure, NamesTheFileThatItCannotWrite) {
  try {
    write_figure("/proc/nowhere", "gap", "", {});
    FAIL() << "wrote to /proc";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/proc/nowhere"));
  }
}

TEST(Figure, QuantilesInterpolate) {
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({1, 2, 3, 4, 5}, 0.25), 2);
  EXPECT_TRUE(std::isnan(median({})));
}

TEST(Source, SimulatesWhereThereAreNoFiles) {
  const DataSet data = load({.poses = 101});
  EXPECT_EQ(data.pairs.size(), 100u);
  EXPECT_TRUE(data.truth);
}

TEST(Source, TakesTruthPlanesAndWeights) {
  const DataSet data = load({.truth = Pose{Eigen::Quaterniond::Identity(), {1, 2, 3}},
                             .plane_a = GroundPlane{},
                             .plane_b = GroundPlane{},
                             .balance = {.rotation = 2, .translation = 0.5},
                             .poses = 11});
  EXPECT_EQ(to_pose(*data.truth).translation, Eigen::Vector3d(1, 2, 3));
  EXPECT_TRUE(data.plane_a && data.plane_b);
  EXPECT_EQ(data.balance.rotation, 2);
  EXPECT_EQ(data.balance.translation, 0.5);
}

TEST(Source, NamesTheFileThatIsMissing) {
  try {
    load({.file_a = "/nowhere/a.tum", .file_b = "/nowhere/b.tum"});
    FAIL() << "read what is not there";
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/a.tum"));
  }
}

TEST(Source, DrivesBetweenCommasAddUp) {
  const testing::ScratchFolder folder;
  for (const int seed : {1, 2}) {
    const Pose T{rotation_exp({0.3, -0.2, 2.0}), {2.5, -1.2, 0.6}};
    SimulationOptions options;
    options.poses = 51;
    options.seed = static_cast<std::uint64_t>(seed);
    options.T_vehicle_sensor = {Pose{}, T};
    const std::vector<Trajectory> drive = simulate(options);
    write_tum(folder.path("a" + std::to_string(seed)), drive[0]);
    write_tum(folder.path("b" + std::to_string(seed)), drive[1]);
  }
  const auto names = [&](const std::string& sensor) {
    return folder.path(sensor + "1") + "," + folder.path(sensor + "2");
  };
  const DataSet both = load({.file_a = names("a"), .file_b = names("b")});
  EXPECT_EQ(both.pairs.size(), 100u);
  // no motion leads from one drive to the next
  const DataSet second = load({.file_a = folder.path("a2"), .file_b = folder.path("b2")});
  ASSERT_EQ(second.pairs.size(), 50u);
  for (std::size_t i = 0; i < 50; ++i) EXPECT_EQ(both.pairs[50 + i].begin_us, second.pairs[i].begin_us);
  EXPECT_THROW(load({.file_a = names("a"), .file_b = folder.path("b1")}), Error);
}

TEST(TableText, IsCsvAndLatexOfTheSameNumbers) {
  std::vector<ComparisonRow> rows = compare(random_data(egocal::testing::Motion::free, 100, 0.01), 1);
  rows[0].verdict = "not valid, \"far\" off";
  rows[0].error->translation = 5000;
  EXPECT_THAT(csv(rows), HasSubstr("\"not valid, \"\"far\"\" off\""));
  const std::string tex = latex(rows);
  EXPECT_THAT(tex, HasSubstr("analytic [19] & 3D & $>10^5$ &"));
  EXPECT_THAT(tex, HasSubstr("\\end{tabular}"));
  EXPECT_THAT(tex, HasSubstr(fmt::format("global (dual) & 3D & {:.2f} &", 100 * rows[4].error->translation)));
}

TEST(Paper, OnePageHoldsEveryTableAndFigureBesideThePrintedNumbers) {
  const testing::ScratchFolder folder;
  const PaperOptions options{.data = "", .out = folder.path("paper"), .full = false, .repeats = 1};
  double last = 0;
  const auto progress = [&](const std::string&, double part) {
    EXPECT_GE(part, last - 1e-12);
    last = part;
  };
  const std::string page = content_of(reproduce_paper(options, progress));
  EXPECT_EQ(last, 1);
  for (const char* part : {"Table I:", "Table II:", "Fig. 3", "Fig. 4", "Fig. 5", "Fig. 6", "Section V-F",
                           "20.76", "1900.0", "224448", "11520 certified", "simulated drives"})
    EXPECT_THAT(page, HasSubstr(part));
  for (const char* outside : {"src=", "href=", "<script", "@import"})
    EXPECT_THAT(page, ::testing::Not(HasSubstr(outside)));
  for (const char* file : {"table-1.tex", "table-2.csv", "fig-3.csv", "fig-4-translation.svg",
                           "fig-5-path.svg", "fig-6-3d-gap.svg", "v-f-rotation.svg"})
    EXPECT_TRUE(std::filesystem::exists(options.out + "/" + file)) << file;

  // a run that was interrupted continues: what is there stays, what is missing or of other options is made
  // again
  const std::string kept = options.out + "/parts/fig-4.html", lost = options.out + "/parts/fig-3.html";
  std::ofstream(kept, std::ios::app) << "<!-- kept -->";
  std::filesystem::remove(lost);
  last = 0;
  EXPECT_THAT(content_of(reproduce_paper(options, progress)), HasSubstr("<!-- kept -->"));
  EXPECT_TRUE(std::filesystem::exists(lost));
}

/// Reads "tx ty tz qw qx qy qz", lines with # skipped.
Pose truth_of(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  while (std::getline(in, line) && (line.empty() || line[0] == '#')) {
  }
  std::istringstream fields(line);
  double v[7] = {};
  for (double& value : v) fields >> value;
  return {Eigen::Quaterniond(v[3], v[4], v[5], v[6]).normalized(), {v[0], v[1], v[2]}};
}

TEST(Compare, RepeatsTableIIOnKitti07) {
  const std::string folder = paths::data_dir() + "/kitti_07";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is absent";
  const DataSet data = load(
      {.file_a = folder + "/velodyne_pylidar.tum",
       .file_b = folder + "/cam0_orbslam2.tum",
       .truth = truth_of(folder + "/truth.txt"),
       .plane_a = validated({{-1.220921993720055186e-02, 2.798845739362088372e-03, 9.999215476281387849e-01},
                             -1.779603641715662210e+00}),
       .plane_b =
           validated({{-6.613857662736873089e-03, -9.998207740635888241e-01, -1.773912730951216279e-02},
                      -1.684677553916568593e+00})});
  EXPECT_EQ(data.pairs.size(), 1100u);
  std::map<std::string, ComparisonRow> by_name;
  for (const ComparisonRow& row : compare(data, 1)) by_name[row.method] = row;
  // the reference is an independent implementation of the paper
  for (const char* name : {"global (dual)", "global (sdp)", "fast (sqp)"}) {
    EXPECT_NEAR(by_name.at(name).error->rotation / degree, 0.278, 5e-4) << name;
    EXPECT_NEAR(by_name.at(name).error->translation, 0.1902, 5e-5) << name;
  }
  EXPECT_NEAR(by_name.at("global (closed form)").error->rotation / degree, 0.262, 5e-4);
  EXPECT_NEAR(by_name.at("global (closed form)").error->translation, 0.1434, 5e-5);
  EXPECT_THAT(by_name.at("analytic [19]").verdict, ::testing::Not("valid"));
  EXPECT_LT(by_name.at("matrix [8]").error->rotation, by_name.at("global (dual)").error->rotation);
}

/// The drives of the page; empty where they are absent.
std::optional<DataSet> drives_of_the_page(const std::vector<std::string>& names) {
  const std::string folder = paths::data_dir();
  std::string a, b;
  for (const std::string& name : names) {
    if (!std::filesystem::exists(folder + "/" + name)) return std::nullopt;
    a += (a.empty() ? "" : ",") + folder + "/" + name + "/velodyne_pylidar.tum";
    b += (b.empty() ? "" : ",") + folder + "/" + name + "/cam0_orbslam2.tum";
  }
  return load(
      {.file_a = a,
       .file_b = b,
       .truth = truth_of(folder + "/kitti_07/truth.txt"),
       .plane_a = validated({{-1.220921993720055186e-02, 2.798845739362088372e-03, 9.999215476281387849e-01},
                             -1.779603641715662210e+00}),
       .plane_b =
           validated({{-6.613857662736873089e-03, -9.998207740635888241e-01, -1.773912730951216279e-02},
                      -1.684677553916568593e+00})});
}

/// Line breaks count as spaces.
std::string page_on_the_paper() {
  std::string page = content_of(paths::source_dir() + "/docs/paper.md");
  std::string flat;
  for (const char c : page)
    if (c != '\n')
      flat += c;
    else if (flat.empty() || flat.back() != ' ')
      flat += ' ';
  for (std::size_t at = flat.find("  "); at != std::string::npos; at = flat.find("  ")) flat.erase(at, 1);
  return flat;
}

TEST(Compare, GivesTheNumbersOfThePageOnThePaper) {
  const std::optional<DataSet> data = drives_of_the_page({"kitti_05", "kitti_07"});
  if (!data) GTEST_SKIP() << "kitti_05 is absent";
  const std::string page = page_on_the_paper();
  int compared = 0;
  for (const ComparisonRow& row : compare(*data, 1)) {
    if (row.verdict != "certified" && row.verdict != "valid") continue;
    const std::string line =
        fmt::format("| {} | {} | {:.2f} | {:.3f} |", row.method, row.mode == Mode::planar ? "planar" : "3-D",
                    100 * row.error->translation, row.error->rotation / degree);
    EXPECT_THAT(page, HasSubstr(line));
    ++compared;
  }
  EXPECT_GE(compared, 8);
}

TEST(Online, GivesTheNumbersOfThePageOnThePaper) {
  const std::optional<DataSet> data = drives_of_the_page({"kitti_07"});
  if (!data) GTEST_SKIP() << "kitti_07 is absent";
  const std::string page = page_on_the_paper();
  for (const Mode mode : {Mode::spatial, Mode::planar}) {
    const std::vector<OnlinePoint> points = online_experiment(*data, mode, data->pairs.size(), {}, {});
    ASSERT_EQ(points.size(), 1100u);
    const auto errors = [&](std::size_t frame) {
      const ExtrinsicError& error = *points[frame - 1].error;
      return fmt::format("{:.2f} cm and {:.3f} degrees", 100 * error.translation, error.rotation / degree);
    };
    const std::string at_the_end = fmt::format("{:.2f} cm", 100 * points.back().error->translation);
    EXPECT_THAT(page, HasSubstr(errors(150)));
    EXPECT_THAT(page, HasSubstr(at_the_end));
    EXPECT_THAT(page, HasSubstr(fmt::format("frame {};", last_global_frame(points))));
    for (const OnlinePoint& point : points) EXPECT_TRUE(point.certified) << point.frame;
    // the answer before does not do for the new motions, the fast solution does
    EXPECT_GT(*points[149].scaled_gap_before, 1);
    EXPECT_LE(points[149].scaled_gap, 1);
  }
}

TEST(Globality, GivesTheNumbersOfThePageOnThePaper) {
  const std::optional<DataSet> data = drives_of_the_page({"kitti_07"});
  if (!data) GTEST_SKIP() << "kitti_07 is absent";
  const std::vector<GlobalityPoint> points = globality_experiment(*data, {});
  for (const GlobalityPoint& point : points) EXPECT_EQ(point.disproved, point.runs) << point.amount;
  const GlobalityOptions tried;
  EXPECT_THAT(page_on_the_paper(),
              HasSubstr(fmt::format("every one from {:g} degrees or {:g} mm on is disproved",
                                    tried.rotations.front(), 1e3 * tried.translations.front())));
}

}  // namespace
}  // namespace egocal::tools::test_experiments
