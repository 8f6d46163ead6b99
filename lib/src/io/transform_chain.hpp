// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "egocal/io/recording.hpp"
#include "egocal/pairing/trajectory.hpp"

namespace egocal::detail {

/// One transform on the way from a frame to another.
struct ChainLink {
  std::size_t stream = 0;
  bool inverted = false;  ///< walked from child to parent
};

/// The shortest chain of transforms from `parent` to `child`, over those of `topic` and all static ones;
/// empty: there is none.
std::optional<std::vector<ChainLink>> find_chain(const std::vector<RecordedStream>& streams,
                                                 const std::string& topic, const std::string& parent,
                                                 const std::string& child);

/// "map/base_link" in its frames: frames may hold slashes themselves, so both parts must be known ones.
std::optional<std::pair<std::string, std::string>> split_frames(const std::vector<RecordedStream>& streams,
                                                                const std::string& text);

/// Poses of the chain's last frame in its first, at the times of the moving transform with the most poses;
/// the others are interpolated. poses: of each link, by time. `dropped` counts times at which another
/// transform has no pose on one side, or a gap above two of its periods and above 1 s.
Trajectory resolve_chain(const std::vector<ChainLink>& links, const std::vector<bool>& fixed,
                         const std::vector<Trajectory>& poses, std::size_t& dropped);

}  // namespace egocal::detail
