// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "experiments/data_set.hpp"
#include "experiments/figure.hpp"
#include "experiments/paper.hpp"

/// The parts of the paper's evaluation: each writes its files and returns its piece of the page.
namespace egocal::tools {

/// The data of the paper's kind that are at hand.
struct PaperData {
  DataSet table_2;           ///< the drives of Table II, concatenated
  DataSet online;            ///< the drive of Fig. 6
  Trajectory path;           ///< the drive of Fig. 5
  std::string table_2_name;  ///< what they are, for the page
  std::string online_name;
};

/// Throws Error naming the file that is missing or damaged.
PaperData paper_data(const PaperOptions& options);

using PartProgress = std::function<void(double)>;

std::string table_1_part(const PaperOptions& options, const PaperData& data, const PartProgress& progress);
std::string table_2_part(const PaperOptions& options, const PaperData& data, const PartProgress& progress);
std::string figure_3_part(const PaperOptions& options, const PaperData& data, const PartProgress& progress);
std::string figure_4_part(const PaperOptions& options, const PaperData& data, const PartProgress& progress);
std::string figure_5_part(const PaperOptions& options, const PaperData& data, const PartProgress& progress);
std::string figure_6_part(const PaperOptions& options, const PaperData& data, const PartProgress& progress);
std::string globality_part(const PaperOptions& options, const PaperData& data, const PartProgress& progress);

/// "<figure><svg ...></figure>" of each panel, side by side.
std::string figures_html(const std::vector<Panel>& panels);

}  // namespace egocal::tools
