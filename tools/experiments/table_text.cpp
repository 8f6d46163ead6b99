// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/table_text.hpp"

#include <fmt/format.h>

#include "egocal/degrees.hpp"

namespace egocal::tools {

namespace {

const char* mode_text(const ComparisonRow& row) {
  return row.mode == Mode::planar ? "planar" : "spatial";
}

/// A field that may hold commas and quotes.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

std::string latex_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string("&%$#_{}").find(c) != std::string::npos) out += '\\';
    out += c;
  }
  return out;
}

/// Beyond a kilometre an error is a failure, as the paper prints it.
std::string latex_translation(const ComparisonRow& row) {
  if (!row.error) return "--";
  if (row.error->translation > 1000) return "$>10^5$";
  return fmt::format("{:.2f}", 100 * row.error->translation);
}

}  // namespace

std::string csv(const std::vector<ComparisonRow>& rows) {
  std::string text = "method,mode,error_translation_m,error_rotation_deg,milliseconds,verdict\n";
  for (const ComparisonRow& row : rows) {
    const std::string errors = row.error ? fmt::format("{:.9g},{:.9g}", row.error->translation,
                                                       degrees_per_radian * row.error->rotation)
                                         : ",";
    text += fmt::format("{},{},{},{:.6g},{}\n", csv_field(row.method), mode_text(row), errors,
                        row.milliseconds, csv_field(row.verdict));
  }
  return text;
}

std::string latex(const std::vector<ComparisonRow>& rows) {
  std::string text =
      "\\begin{tabular}{llrrr}\n\\hline\nApproach & Mode & $\\epsilon_t$ [cm] & $\\epsilon_r$ "
      "[$^\\circ$] & Time [ms] \\\\\n\\hline\n";
  for (const ComparisonRow& row : rows)
    text += fmt::format("{} & {} & {} & {} & {:.4f} \\\\\n", latex_text(row.method),
                        row.mode == Mode::planar ? "planar" : "3D", latex_translation(row),
                        row.error ? fmt::format("{:.3f}", degrees_per_radian * row.error->rotation) : "--",
                        row.milliseconds);
  return text + "\\hline\n\\end{tabular}\n";
}

}  // namespace egocal::tools
