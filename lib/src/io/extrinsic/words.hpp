// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

#include <array>
#include <string>
#include <vector>

#include "egocal/io/extrinsic_text.hpp"

namespace egocal::detail {

/// What every format says about an extrinsic, with names that are safe in all of them.
struct ExtrinsicWords {
  explicit ExtrinsicWords(const NamedExtrinsic& named);

  const NamedExtrinsic& extrinsic;
  const Pose& T;          ///< T_parent_child
  std::string a, b;       ///< parent, child
  std::string direction;  ///< "pose of b in a: p_a = R * p_b + t"
  std::string lengths;    ///< "metres", or "lengths in the unit of b"
  /// The verdict with its reason, then what is not shown, then the rest: "verdict good: ...; certified
  /// globally optimal, from 1234 motion pairs". Optimal is not the same as right, so that is never said
  /// alone.
  std::string verdict;
  /// The same for a format with the inverse, whose numbers mix the directions.
  std::string verdict_of_inverse;
};

/// The directions of one kind by name: {"z", "yaw"}.
std::vector<std::string> directions_with(const NamedExtrinsic& extrinsic, Backing backing);
/// Directions that the motions do not show: those of the nominal value or of nothing.
std::vector<std::string> not_observable(const NamedExtrinsic& extrinsic);
/// What the number of each direction rests on, by standard deviations where nothing else is known.
std::array<Backing, 6> backing_of(const NamedExtrinsic& extrinsic);
/// The frame that the directions of the extrinsic are of.
const std::string& backing_frame(const NamedExtrinsic& extrinsic);

/// Text in quotes for JSON and YAML.
std::string in_quotes(const std::string& text);
/// ["z", "yaw"].
std::string list_in_quotes(const std::vector<std::string>& words);

/// The shortest text that reads back as exactly this double, in YAML 1.1 too.
std::string exact(double value);

template <class Vector>
std::string joined(const Vector& values, const char* separator) {
  std::string text;
  for (Eigen::Index i = 0; i < values.size(); ++i) text += (i ? separator : "") + exact(values(i));
  return text;
}

Eigen::Vector4d wxyz(const Eigen::Quaterniond& q);
Eigen::Vector4d xyzw(const Eigen::Quaterniond& q);
/// The nine numbers of the rotation matrix, row by row.
Eigen::Matrix<double, 9, 1> rotation_rows(const Eigen::Quaterniond& q);
/// Four lines "- [r, r, r, t]".
std::string matrix_rows(const Pose& T, const std::string& indent);
/// Letters, digits and _ - . / of a frame's name, no - first; nothing in it may end a quote, a comment or a
/// line.
std::string frame_name(const std::string& name);
/// Such a name as a word of YAML 1.1, in quotes where it would be a truth value, nothing or a number.
std::string yaml_word(const std::string& name);

// One format each: the whole text of a file.
std::string yaml_text(const ExtrinsicWords& words);
std::string json_text(const ExtrinsicWords& words);
std::string ros_text(const ExtrinsicWords& words);
std::string ros_launch_text(const ExtrinsicWords& words);
std::string ros_launch_node(const ExtrinsicWords& words);  ///< without <launch> around it
std::string urdf_text(const ExtrinsicWords& words);
std::string kalibr_text(const ExtrinsicWords& words);
std::string autoware_text(const ExtrinsicWords& words);
std::string lio_sam_text(const ExtrinsicWords& words);
std::string opencv_text(const ExtrinsicWords& words);
std::string matrix_text(const ExtrinsicWords& words);

}  // namespace egocal::detail
