// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "figures/plot.hpp"

namespace egocal::tools {

/// One picture of an experiment.
struct Panel {
  std::string name;  ///< part of the file's name: "rotation"
  Plot plot;
};

/// Writes DIRECTORY/NAME.csv and DIRECTORY/NAME-PANEL.svg for each panel, and a PDF beside each SVG where
/// rsvg-convert is installed; makes the directory. Returns the files written. Throws Error naming the file
/// that could not be written.
std::vector<std::string> write_figure(const std::string& directory, const std::string& name,
                                      const std::string& csv, const std::vector<Panel>& panels);

/// Median of the values; NaN where there are none.
double median(std::vector<double> values);
/// The value below which this part of the values lies, 0 to 1; NaN where there are none.
double quantile(std::vector<double> values, double part);

}  // namespace egocal::tools
