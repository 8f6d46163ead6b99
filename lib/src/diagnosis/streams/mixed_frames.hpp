// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Poses of two frames in one stream: of two publishers on one topic, or two children of one tree in one file.
#pragma once

#include <cstddef>
#include <optional>

#include "diagnosis/motions/motions.hpp"
#include "egocal/diagnosis/diagnose.hpp"

namespace egocal::detail {

struct MixedFramesOptions {
  /// The longest pattern that is found [instants]: longer motions are not compared with single steps.
  std::size_t longest = 6;
  std::size_t most = 600;  ///< motions of each length that are looked at, for time
  std::size_t least = 24;  ///< instants: fewer motions have no typical residual
  /// Single steps leave this many times what longer motions leave. Noise cannot: of motions it grows with
  /// their number, and that of poses is the same (1.0 to 1.1).
  double times = 4;
  /// A single step leaves at least this part of what typical motions of the longest pattern move by, lest
  /// rounding counts where nothing is left.
  double least_part = 1e-3;
  /// What single steps leave is the distance of the frames, always the same (test_mixed_frames: it scatters
  /// by 0.3 to 2 %). Of 72 machines that are shaken faster than they are measured six leave single steps,
  /// too, but of any size (28 to 59 %).
  double most_scatter = 0.1;
  /// Residuals of single steps, which are the distance of the frames, scatter this many times less than they
  /// do as parts of the way: those of stamps that alternate, and of held values, are a part of the way. At
  /// one speed the two are alike.
  double clearly_constant = 2;
  /// Part of what single steps leave that is across the way: of stamps on the ticks of a slower clock 0.5 to
  /// 4 % (FrameJumpsOptions).
  double across = 0.2;
};

/// Two frames whose jumps are alike (mixed_frames_jumps.hpp), or several by turns: single steps contradict
/// the answer, motions of a few steps do not, and not by a part of the way. Uncertain where the speed hardly
/// changes and what the steps leave is along the way: stamps that alternate would leave the same. By turns
/// the stream is the one whose steps differ from their neighbours, but not from those one pattern later.
/// Finding mixed_frames_a or mixed_frames_b.
std::optional<Finding> mixed_frames(const Instants& instants, const Pose& T_a_b, bool metres,
                                    const MixedFramesOptions& options = {});

}  // namespace egocal::detail
