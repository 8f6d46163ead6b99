// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/compare.hpp"

#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "commands/source_options.hpp"
#include "egocal/bus/pose_json.hpp"
#include "egocal/degrees.hpp"
#include "experiments/comparison.hpp"
#include "experiments/table_text.hpp"
#include "offline/printing/provenance.hpp"

namespace egocal::tools {

namespace {

struct CompareOptions {
  Source source;
  int repeats = 10;
  bool json = false, csv = false, latex = false;
};

nlohmann::ordered_json comparison_json(const ComparisonRow& row) {
  nlohmann::ordered_json json;
  json["method"] = row.method;
  json["mode"] = row.mode == Mode::planar ? "planar" : "spatial";
  bus::put_pose(json, to_pose(row.T_a_b));
  if (row.error) {
    json["error_translation_m"] = row.error->translation;
    json["error_rotation_deg"] = row.error->rotation * degrees_per_radian;
  }
  json["milliseconds"] = row.milliseconds;
  json["verdict"] = row.verdict;
  return json;
}

void run_compare(const CompareOptions& options, const std::string& command_line) {
  const DataSet data = load_warning(options.source);
  const std::vector<ComparisonRow> rows = compare(data, options.repeats);
  if (options.json) {
    nlohmann::ordered_json json = provenance_json(command_line);
    json["files"] = files_json({{"a", options.source.file_a},
                                {"b", options.source.file_b},
                                {"times_a", options.source.reading_a.times_file},
                                {"times_b", options.source.reading_b.times_file}});
    json["notes"] = data.notes;
    json["pairs"] = data.pairs.size();
    json["methods"] = nlohmann::ordered_json::array();
    for (const ComparisonRow& row : rows) json["methods"].push_back(comparison_json(row));
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
    return;
  }
  if (options.csv || options.latex) {
    fmt::print("{}", options.csv ? csv(rows) : latex(rows));
    return;
  }
  fmt::print("{} motion pairs; times from the pairs to the answer, median of {}\n\n{}", data.pairs.size(),
             options.repeats, table(rows));
}

}  // namespace

void add_compare(cli::App program) {
  const auto options = std::make_shared<CompareOptions>();
  cli::App command =
      program.add_subcommand("compare", "every method on one data set: the paper's Tables I and II");
  add_source_options(command, options->source);
  command.add_option("--repeats", options->repeats, "of each method, for its time")
      .show_default()
      .check(cli::Check::range(1, 100000));
  const cli::Option json = command.add_flag("--json", options->json, "one JSON object on standard output");
  const cli::Option csv = command.add_flag("--csv", options->csv, "the table as CSV").excludes(json);
  command.add_flag("--latex", options->latex, "the table as LaTeX").excludes(json).excludes(csv);
  command.callback([options, command] { run_compare(*options, command.command_line()); });
}

}  // namespace egocal::tools
