// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/reports.hpp"

#include <unistd.h>

#include "egocal/error.hpp"
#include "supervision/output_file.hpp"
#include "warnings.hpp"

namespace egocal::tools {

Reports::~Reports() {
  if (output_ >= 0) close(output_);
}

void Reports::report(const std::string& line, bool at_the_end_too) {
  if (!quiet_ || folder_.empty()) {
    say("egocal up: " + line);
    return;
  }
  if (at_the_end_too) last_line_ = line;
  try {
    if (output_ < 0) output_ = open_output(folder_ + "/up.out");
  } catch (const Error&) {
    last_line_ = line;
    return;
  }
  const std::string text = line + "\n";
  if (write(output_, text.data(), text.size()) < 0) last_line_ = line;
}

void Reports::end() const {
  if (!last_line_.empty()) say("egocal up: " + last_line_);
}

}  // namespace egocal::tools
