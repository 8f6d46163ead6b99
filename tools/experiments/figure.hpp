// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace egocal::tools {

/// What write_figure left behind.
struct FigureFiles {
  std::string csv, script;
  std::string png;  ///< empty where gnuplot is not installed or failed
};

/// Names of the files of one figure.
FigureFiles figure_files(const std::string& directory, const std::string& name);

/// Writes CSV and gnuplot script, and draws the PNG where gnuplot is installed; makes the directory. Throws
/// Error naming the file that could not be written.
FigureFiles write_figure(const FigureFiles& files, const std::string& csv, const std::string& script);

}  // namespace egocal::tools
