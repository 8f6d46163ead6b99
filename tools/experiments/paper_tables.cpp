// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <chrono>
#include <span>

#include "egocal/calibrate.hpp"
#include "egocal/degrees.hpp"
#include "egocal/io/whole_file.hpp"
#include "egocal/simulation/simulation.hpp"
#include "experiments/comparison.hpp"
#include "experiments/paper_parts.hpp"
#include "experiments/paper_values.hpp"
#include "experiments/table_text.hpp"

namespace egocal::tools {

namespace {

/// Beyond a kilometre the paper prints "> 10^5", which is a failure.
std::string centimetres(double metres) {
  return metres >= 1000 ? "&gt; 10<sup>5</sup>" : fmt::format("{:.2f}", 100 * metres);
}

std::string cells(const std::string& method, const char* mode, const std::string& translation,
                  const std::string& rotation, const std::string& time, const std::string& note) {
  return fmt::format(
      "<td>{}</td><td>{}</td><td class='n'>{}</td><td class='n'>{}</td><td class='n'>{}</td><td>{}</td>",
      escaped(method), mode, translation, rotation, time, escaped(note));
}

std::string paper_rows(std::span<const paper::TableRow> rows, const char* mode) {
  std::string text;
  for (const paper::TableRow& row : rows)
    text += "<tr class='paper'>" +
            cells(row.method, mode, centimetres(row.translation_cm / 100),
                  fmt::format("{:.3f}", row.rotation_deg), fmt::format("{:.1f}", row.milliseconds),
                  "printed in the paper") +
            "</tr>\n";
  return text;
}

std::string our_rows(const std::vector<ComparisonRow>& rows, Mode mode) {
  std::string text;
  for (const ComparisonRow& row : rows) {
    if (row.mode != mode) continue;
    text += "<tr>" +
            cells(row.method, mode == Mode::planar ? "planar" : "3-D",
                  row.error ? centimetres(row.error->translation) : "-",
                  row.error ? fmt::format("{:.3f}", degrees_per_radian * row.error->rotation) : "-",
                  fmt::format("{:.4f}", row.milliseconds), row.verdict) +
            "</tr>\n";
  }
  return text;
}

constexpr const char* header =
    "<table>\n<tr><th>approach</th><th>mode</th><th>&epsilon;<sub>t</sub> [cm]</th><th>&epsilon;<sub>r</sub> "
    "[deg]</th><th>time [ms]</th><th></th></tr>\n";

void write_table(const PaperOptions& options, const std::string& name,
                 const std::vector<ComparisonRow>& rows) {
  const std::string stem = options.out + "/" + name;
  write_whole_file(stem + ".csv", csv(rows));
  write_whole_file(stem + ".tex", latex(rows));
  write_whole_file(stem + ".txt", table(rows));
}

/// What `egocal solve` does with the same motions: outliers rejected, weights chosen by the spread.
ComparisonRow automatic(const DataSet& data, Mode mode) {
  CalibrationOptions options;
  options.pairing.mode = mode;
  if (data.plane_a) options.pairing.plane_a = *data.plane_a;
  if (data.plane_b) options.pairing.plane_b = *data.plane_b;
  const auto begin = std::chrono::steady_clock::now();
  const Calibration calibration = calibrate(data.pairs, options);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - begin;
  ComparisonRow row{"egocal, automatic weights",
                    mode,
                    to_dual_quaternion(calibration.T_a_b),
                    {},
                    time.count(),
                    std::string(to_string(calibration.certificate.optimality))};
  if (data.truth) row.error = extrinsic_error(*data.truth, row.T_a_b);
  return row;
}

}  // namespace

std::string table_1_part(const PaperOptions& options, const PaperData&, const PartProgress&) {
  // Two hand-held cameras a few centimetres apart. The noise is that at which the global solution errs as
  // much as in the paper.
  SimulationOptions simulation;
  simulation.terrain = Terrain::free;
  simulation.poses = paper::table_1_frames + 1;
  simulation.speed = 0.5;
  simulation.relative_noise = 0.07;
  const Pose T{rotation_exp({0.2, 0.1, -0.4}), {0.25, 0.05, -0.1}};
  simulation.T_vehicle_sensor = {Pose{}, T};
  const std::vector<Trajectory> drive = simulate(simulation);
  DataSet data;
  data.pairs = motions(drive[0], drive[1]);
  data.truth = to_dual_quaternion(T);
  std::vector<ComparisonRow> rows = compare(data, options.repeats);
  rows.push_back(automatic(data, Mode::spatial));
  write_table(options, "table-1", rows);
  return fmt::format(
             "<p>The paper uses 200 frames of two RGB-D cameras, which are not at hand. Here: {} "
             "simulated frames of two hand-held sensors 27 cm apart, {:g} % noise. Times: median of "
             "{}.</p>\n",
             data.pairs.size(), 100 * simulation.relative_noise, options.repeats) +
         header + paper_rows(paper::table_1, "3-D") + our_rows(rows, Mode::spatial) + "</table>\n";
}

std::string table_2_part(const PaperOptions& options, const PaperData& data, const PartProgress&) {
  std::vector<ComparisonRow> rows = compare(data.table_2, options.repeats);
  rows.push_back(automatic(data.table_2, Mode::spatial));
  if (data.table_2.plane_a) rows.push_back(automatic(data.table_2, Mode::planar));
  write_table(options, "table-2", rows);
  std::string text = fmt::format(
      "<p>The paper: KITTI odometry 04 to 10, {} frames, A-LOAM and OpenVSLAM. Here: {}, {} frames; other "
      "odometries, so "
      "other errors. Times: median of {}.</p>\n",
      paper::table_2_frames, escaped(data.table_2_name), data.table_2.pairs.size(), options.repeats);
  text += header + paper_rows(paper::table_2_spatial, "3-D") + our_rows(rows, Mode::spatial) +
          paper_rows(paper::table_2_planar, "planar") + our_rows(rows, Mode::planar) + "</table>\n";
  for (const ComparisonRow& row : rows)
    if (row.method.rfind("analytic", 0) == 0 && row.verdict != "valid")
      text += "<p>The analytic method fails, here as in the paper: " + escaped(row.verdict) + ".</p>\n";
  return text;
}

}  // namespace egocal::tools
