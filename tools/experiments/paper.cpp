// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "experiments/paper.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "egocal/version.hpp"
#include "experiments/paper_parts.hpp"

namespace egocal::tools {

namespace {

struct Part {
  const char* name;
  const char* title;
  std::string (*make)(const PaperOptions&, const PaperData&, const PartProgress&);
};

constexpr Part parts[] = {
    {"table-1", "Table I: six degrees of freedom", table_1_part},
    {"table-2", "Table II: a car", table_2_part},
    {"fig-3", "Fig. 3: a simulated path", figure_3_part},
    {"fig-4", "Fig. 4: noise and number of motions", figure_4_part},
    {"fig-5", "Fig. 5: the drive", figure_5_part},
    {"fig-6", "Fig. 6: online estimation", figure_6_part},
    {"v-f", "Section V-F: globality verification", globality_part},
};

constexpr const char* head = R"(<!DOCTYPE html>
<html lang='en'>
<head>
<meta charset='utf-8'>
<title>The paper's experiments, by egocal</title>
<style>
body { font: 15px/1.45 Helvetica, Arial, sans-serif; color: #1a1a1a; max-width: 62rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.5rem; } h2 { font-size: 1.15rem; margin: 1.8rem 0 .4rem; border-bottom: 1px solid #bbb; }
table { border-collapse: collapse; margin: .5rem 0; } td, th { padding: .15rem .9rem .15rem 0; text-align: left; vertical-align: top; }
td.n { font-variant-numeric: tabular-nums; text-align: right; } tr.paper { color: #444; font-style: italic; }
.figures { display: flex; flex-wrap: wrap; gap: 1rem; } figure { margin: 0; }
@media print { body { margin: 0; max-width: none; } h2 { break-after: avoid; } figure, table { break-inside: avoid; } }
</style>
</head>
<body>
<h1>The paper's experiments, by egocal</h1>
<p>Horn, Wodtko, Buchholz, Dietmayer: <i>Online Extrinsic Calibration based on Per-Sensor Ego-Motion Using Dual
Quaternions</i>, RA-L 2021. Rows in italics are printed in the paper; all others were computed by this run. Times are of this machine,
the paper's are of another one.</p>
)";

/// What a part depends on: an older file of other options is not taken for it.
std::string key(const PaperOptions& options) {
  return fmt::format("<!-- egocal {}, data {}, {} size, {} repeats -->\n", version(),
                     options.data.empty() ? "simulated" : std::filesystem::absolute(options.data).string(),
                     options.full ? "full" : "small", options.repeats);
}

std::optional<std::string> kept(const std::string& file, const std::string& key) {
  std::ifstream stream(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (!stream || text.rfind(key, 0) != 0) return std::nullopt;
  return text.substr(key.size());
}

}  // namespace

std::string reproduce_paper(const PaperOptions& options,
                            const std::function<void(const std::string&, double)>& progress) {
  const PaperData data = paper_data(options);  // before the folder: what is refused leaves nothing behind
  const std::string folder = options.out + "/parts";
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error(folder + ": " + failure.message());
  std::string page = head;
  double done = 0;
  for (const Part& part : parts) {
    const std::string file = folder + "/" + part.name + ".html";
    std::optional<std::string> text = kept(file, key(options));
    if (!text) {
      constexpr double share = 1.0 / std::size(parts);  // of the progress
      const auto of_part = [&](double fraction) {
        if (progress) progress(part.title, done + share * fraction);
      };
      of_part(0);
      text = part.make(options, data, of_part);
      write_whole_file(file, key(options) + *text);
    }
    done += 1.0 / std::size(parts);
    page += fmt::format("<h2>{}</h2>\n{}", part.title, *text);
  }
  page += fmt::format(
      "<p>egocal {}. The numbers of each figure are in a CSV file beside this page.</p>\n</body>\n</html>\n",
      version());
  std::string name = options.out + "/paper.html";
  write_whole_file(name, page);
  if (progress) progress("done", 1);
  return name;
}

}  // namespace egocal::tools
