// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Messages of one sender, as a stream gets them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <vector>

#include "egocal/pairing/stream.hpp"

namespace egocal::testing {

/// Messages at 10 Hz, numbered from 0; time in steps of 0.1 s.
inline NumberedPose sample(std::int64_t step, std::int64_t seq) {
  NumberedPose s;
  s.pose.time_us = 1'000'000'000 + step * 100'000;
  s.seq = seq;
  return s;
}

/// The steps of what comes out; -1 before what begins anew.
inline std::vector<std::int64_t> feed(Stream& stream, std::initializer_list<NumberedPose> samples) {
  std::vector<std::int64_t> steps;
  for (const NumberedPose& s : samples)
    for (const NumberedPose& out : stream.push(s)) {
      if (out.begins_anew) steps.push_back(-1);
      steps.push_back((out.pose.time_us - 1'000'000'000) / 100'000);
    }
  return steps;
}

}  // namespace egocal::testing
