// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/transform_chain.hpp"

#include <algorithm>
#include <deque>
#include <map>

#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

bool usable(const RecordedStream& stream, const std::string& topic) {
  return !stream.child.empty() && stream.name != stream.topic && (stream.topic == topic || stream.fixed);
}

/// Poses further apart are not interpolated between [us].
std::int64_t largest_gap(const Trajectory& poses) {
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < poses.size(); ++i) steps.push_back(poses[i].time_us - poses[i - 1].time_us);
  if (steps.empty()) return 0;
  return std::max<std::int64_t>(1'000'000, 2 * median(std::move(steps)));
}

std::optional<DualQuaternion> pose_at(const Trajectory& poses, std::int64_t time_us, std::int64_t gap_us) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), time_us,
                                      [](const StampedPose& p, std::int64_t t) { return p.time_us < t; });
  if (after == poses.end()) return std::nullopt;
  if (after->time_us == time_us) return after->pose;
  if (after == poses.begin()) return std::nullopt;
  const auto before = after - 1;
  const std::int64_t gap = after->time_us - before->time_us;
  if (gap > gap_us) return std::nullopt;
  return interpolate(before->pose, after->pose,
                     static_cast<double>(time_us - before->time_us) / static_cast<double>(gap));
}

}  // namespace

std::optional<std::vector<ChainLink>> find_chain(const std::vector<RecordedStream>& streams,
                                                 const std::string& topic, const std::string& parent,
                                                 const std::string& child) {
  std::map<std::string, std::vector<std::pair<std::string, ChainLink>>> ways;
  for (std::size_t i = 0; i < streams.size(); ++i) {
    if (!usable(streams[i], topic)) continue;
    ways[streams[i].parent].push_back({streams[i].child, {i, false}});
    ways[streams[i].child].push_back({streams[i].parent, {i, true}});
  }
  // breadth first from the parent
  std::map<std::string, std::pair<std::string, ChainLink>> came_from{{parent, {}}};
  std::deque<std::string> open{parent};
  while (!open.empty() && !came_from.contains(child)) {
    const std::string frame = open.front();
    open.pop_front();
    for (const auto& [next, link] : ways[frame])
      if (came_from.try_emplace(next, frame, link).second) open.push_back(next);
  }
  if (parent == child || !came_from.contains(child)) return std::nullopt;
  std::vector<ChainLink> links;
  for (std::string frame = child; frame != parent; frame = came_from[frame].first)
    links.push_back(came_from[frame].second);
  std::reverse(links.begin(), links.end());
  return links;
}

std::optional<std::pair<std::string, std::string>> split_frames(const std::vector<RecordedStream>& streams,
                                                                const std::string& text) {
  const auto known = [&](const std::string& frame) {
    return std::any_of(streams.begin(), streams.end(), [&](const RecordedStream& stream) {
      return stream.name != stream.topic && (stream.parent == frame || stream.child == frame);
    });
  };
  for (std::size_t at = text.find('/'); at != std::string::npos; at = text.find('/', at + 1))
    if (known(text.substr(0, at)) && known(text.substr(at + 1)))
      return std::pair(text.substr(0, at), text.substr(at + 1));
  return std::nullopt;
}

Trajectory resolve_chain(const std::vector<ChainLink>& links, const std::vector<bool>& fixed,
                         const std::vector<Trajectory>& poses, std::size_t& dropped) {
  dropped = 0;
  std::size_t reference = links.size();
  std::vector<std::int64_t> gaps(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (poses[i].empty()) return {};
    gaps[i] = largest_gap(poses[i]);
    if (!fixed[i] && (reference == links.size() || poses[i].size() > poses[reference].size())) reference = i;
  }
  if (reference == links.size()) return {};  // nothing moves
  Trajectory result;
  result.reserve(poses[reference].size());
  for (const StampedPose& at : poses[reference]) {
    DualQuaternion pose;
    bool known = true;
    for (std::size_t i = 0; i < links.size() && known; ++i) {
      const auto link =
          fixed[i] ? std::optional(poses[i].front().pose) : pose_at(poses[i], at.time_us, gaps[i]);
      known = link.has_value();
      if (known) pose = pose * (links[i].inverted ? conjugate(*link) : *link);
    }
    if (known)
      result.push_back({at.time_us, normalized(pose)});
    else
      ++dropped;
  }
  return result;
}

}  // namespace egocal::detail
