// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/extrinsic_tree.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>

#include "egocal/error.hpp"
#include "io/extrinsic/words.hpp"

namespace egocal {

namespace {

constexpr std::array tree_formats{ExtrinsicFormat::urdf, ExtrinsicFormat::ros, ExtrinsicFormat::ros_launch,
                                  ExtrinsicFormat::yaml, ExtrinsicFormat::json};

/// Standard deviation of the translation [m]; infinite where it is not known.
double uncertainty(const NamedExtrinsic& pair) {
  if (!pair.stddev) return std::numeric_limits<double>::infinity();
  // std::hypot of three is no number where one of them is infinite
  return Eigen::Map<const Eigen::Vector3d>(pair.stddev->data()).norm();
}

bool more_certain(const NamedExtrinsic& one, const NamedExtrinsic& other) {
  const bool good = one.certified && one.usable, other_good = other.certified && other.usable;
  if (good != other_good) return good;
  const double u = uncertainty(one), v = uncertainty(other);
  return u < v;  // false where both are unknown: the order given decides
}

NamedExtrinsic reversed(const NamedExtrinsic& pair) {
  NamedExtrinsic result = pair;
  std::swap(result.parent, result.child);
  result.T_parent_child = inverse(pair.T_parent_child);
  result.stddev.reset();  // they are in the frame of the other sensor
  result.backing = detail::backing_of(pair);
  result.backing_frame = detail::backing_frame(pair);
  return result;
}

/// Sensors that are connected have the same number.
class Groups {
 public:
  std::size_t of(const std::string& name) {
    std::size_t at = index_.try_emplace(name, parent_.size()).first->second;
    if (at == parent_.size()) parent_.push_back(at);
    while (parent_[at] != at) at = parent_[at];
    return at;
  }
  /// Joins the groups of two frames; false where they were one group already.
  bool join(const std::string& a, const std::string& b) {
    const std::size_t x = of(a), y = of(b);
    parent_[std::max(x, y)] = std::min(x, y);
    return x != y;
  }

 private:
  std::map<std::string, std::size_t> index_;
  std::vector<std::size_t> parent_;
};

std::string robot_text(const ExtrinsicTree& tree) {
  std::string text = "<?xml version=\"1.0\"?>\n<robot name=\"sensors\">\n<link name=\"" +
                     detail::frame_name(tree.root) + "\"/>\n";
  for (const NamedExtrinsic& edge : tree.edges)
    text += "<link name=\"" + detail::frame_name(edge.child) + "\"/>\n";
  for (const NamedExtrinsic& edge : tree.edges) text += detail::urdf_text(detail::ExtrinsicWords(edge));
  return text + "</robot>\n";
}

std::string launch_text(const ExtrinsicTree& tree) {
  std::string text = "<launch>\n";
  for (const NamedExtrinsic& edge : tree.edges) text += detail::ros_launch_node(detail::ExtrinsicWords(edge));
  return text + "</launch>\n";
}

std::string json_tree(const ExtrinsicTree& tree) {
  std::string text = "{\n\"root\": \"" + detail::frame_name(tree.root) + "\",\n\"edges\": [\n";
  for (std::size_t i = 0; i < tree.edges.size(); ++i)
    text += (i > 0 ? ",\n" : "") + detail::json_text(detail::ExtrinsicWords(tree.edges[i]));
  return text + "]\n}\n";
}

/// Refuses names that would become one frame, as they differ only in characters that no format allows.
void refuse_equal_names(const std::vector<NamedExtrinsic>& pairs) {
  std::map<std::string, std::string> names;
  for (const NamedExtrinsic& pair : pairs)
    for (const std::string& name : {pair.parent, pair.child})
      if (const auto& known = *names.try_emplace(detail::frame_name(name), name).first; known.second != name)
        throw Error("'" + known.second + "' and '" + name + "' would both be the frame " + known.first +
                    ": rename one");
}

}  // namespace

ExtrinsicTree extrinsic_tree(const std::vector<NamedExtrinsic>& pairs, const std::string& root) {
  if (pairs.empty()) throw Error("a tree of extrinsics needs at least one pair");
  ExtrinsicTree tree;
  tree.root = root.empty() ? pairs.front().parent : root;
  std::vector<const NamedExtrinsic*> ranked;
  ranked.reserve(pairs.size());
  for (const NamedExtrinsic& pair : pairs) ranked.push_back(&pair);
  std::stable_sort(ranked.begin(), ranked.end(), [](const NamedExtrinsic* one, const NamedExtrinsic* other) {
    return more_certain(*one, *other);
  });
  Groups groups;
  std::vector<const NamedExtrinsic*> chosen;
  for (const NamedExtrinsic* pair : ranked)
    if (groups.join(pair->parent, pair->child))
      chosen.push_back(pair);
    else
      tree.unused.push_back(*pair);
  for (const NamedExtrinsic& pair : pairs)
    for (const std::string& name : {pair.parent, pair.child})
      if (groups.of(name) != groups.of(tree.root))
        throw Error("no pair connects " + name + " with " + tree.root + ": they are not one tree");
  // from the root outwards
  std::vector<std::string> reached{tree.root};
  for (std::size_t i = 0; i < reached.size(); ++i)
    for (const NamedExtrinsic*& pair : chosen) {
      if (!pair || (pair->parent != reached[i] && pair->child != reached[i])) continue;
      tree.edges.push_back(pair->parent == reached[i] ? *pair : reversed(*pair));
      reached.push_back(tree.edges.back().child);
      pair = nullptr;
    }
  return tree;
}

bool holds_tree(ExtrinsicFormat format) {
  return std::find(tree_formats.begin(), tree_formats.end(), format) != tree_formats.end();
}

std::string tree_format_names() {
  std::string names(to_string(tree_formats.front()));
  for (std::size_t i = 1; i < tree_formats.size(); ++i)
    names.append(i + 1 < tree_formats.size() ? ", " : " or ").append(to_string(tree_formats[i]));
  return names;
}

std::string extrinsic_tree_text(const ExtrinsicTree& tree, ExtrinsicFormat format) {
  refuse_equal_names(tree.edges);
  if (format == ExtrinsicFormat::urdf) return robot_text(tree);
  if (format == ExtrinsicFormat::ros_launch) return launch_text(tree);
  if (format == ExtrinsicFormat::json) return json_tree(tree);
  if (!holds_tree(format))
    throw Error(std::string(to_string(format)) + ": holds one extrinsic; a tree can be written as " +
                tree_format_names());
  std::string text;
  for (const NamedExtrinsic& edge : tree.edges)
    text += (format == ExtrinsicFormat::yaml && !text.empty() ? "---\n" : "") + extrinsic_text(edge, format);
  return text;
}

}  // namespace egocal
