// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// Whether parts of one real drive agree as well as their standard deviations say: the answer of each part
// against the mean of the others, per direction. What all parts share, such as a camera whose calibration
// bends every curve, does not show. The table of docs/trust_measured.md.
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "egocal/calibrate.hpp"
#include "egocal/cli/cli.hpp"
#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "markdown_tables.hpp"
#include "study_drives.hpp"
#include "uncertainty/frame_a.hpp"

namespace {

using namespace egocal;

struct Coverage {
  std::array<int, 6> all{}, covered{};
};

Trajectory part_of(const Trajectory& trajectory, std::int64_t begin_us, std::int64_t end_us) {
  Trajectory part;
  for (const StampedPose& pose : trajectory)
    if (pose.time_us >= begin_us && pose.time_us < end_us) part.push_back(pose);
  return part;
}

std::optional<Calibration> answer_of(const bench::StudyDrive& drive, int part, int parts) {
  const Trajectory& a = drive.streams.a;
  const std::int64_t begin = a.front().time_us, length = a.back().time_us - begin;
  const std::int64_t from = begin + length * part / parts, to = begin + length * (part + 1) / parts;
  CalibrationOptions options;
  options.pairing = drive.streams.options;
  options.diagnosis.enabled = false;
  try {
    return calibrate(part_of(a, from, to), part_of(drive.streams.b, from, to), options);
  } catch (const Error&) {
    return std::nullopt;  // too short
  }
}

void add(const bench::StudyDrive& drive, int parts, Coverage& coverage) {
  std::vector<Calibration> answers;
  for (int part = 0; part < parts; ++part)
    if (std::optional<Calibration> answer = answer_of(drive, part, parts))
      answers.push_back(*std::move(answer));
  if (answers.size() < 2) return;
  const DualQuaternion origin = to_dual_quaternion(answers.front().T_a_b);
  for (std::size_t k = 0; k < 6; ++k) {
    std::vector<std::array<double, 2>> known;  // value and variance
    for (const Calibration& answer : answers) {
      const double stddev = answer.observability.stddev[k];
      if (!answer.observability.observable[k] || !std::isfinite(stddev)) continue;
      const detail::Vector6d x = detail::frame_a_difference(origin, to_dual_quaternion(answer.T_a_b));
      known.push_back({x[static_cast<Eigen::Index>(k)], stddev * stddev});
    }
    if (known.size() < 2) continue;
    for (std::size_t i = 0; i < known.size(); ++i) {
      double sum = 0, weights = 0;
      for (std::size_t j = 0; j < known.size(); ++j) {
        if (j == i) continue;
        sum += known[j][0] / known[j][1];
        weights += 1 / known[j][1];
      }
      ++coverage.all[k];
      coverage.covered[k] +=
          std::abs(known[i][0] - sum / weights) <= 1.96 * std::sqrt(known[i][1] + 1 / weights);
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program app("segment_study", "whether parts of a real drive agree within their standard deviations");
  int parts = 4;
  std::string write;
  app.add_option("--parts", parts, "of each drive").check(cli::Check::range(2, 100)).show_default();
  app.add_option("--write", write, "a page: put the table in its place");
  if (const auto code = app.parse(argc, argv)) return *code;
  std::map<std::string, Coverage> kinds;
  for (const bench::StudyDrive& drive : bench::real_study_drives(false))
    if (!drive.kind.starts_with("sets")) add(drive, parts, kinds[drive.kind]);
  bench::Table table{"segments", {{"drives", "x", "y", "z", "roll", "pitch", "yaw"}}};
  for (const auto& [kind, coverage] : kinds) {
    table.rows.push_back({kind});
    for (std::size_t k = 0; k < 6; ++k)
      table.rows.back().push_back(std::to_string(coverage.covered[k]) + " of " +
                                  std::to_string(coverage.all[k]));
  }
  std::printf("%s\n", bench::markdown(table).c_str());
  if (!write.empty()) write_whole_file(write, bench::with_table(bench::read_page(write), table));
  return 0;
}
