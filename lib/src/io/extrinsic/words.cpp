// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/extrinsic/words.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>

#include "egocal/error.hpp"
#include "io/number_text.hpp"

namespace egocal::detail {

ExtrinsicWords::ExtrinsicWords(const NamedExtrinsic& named)
    : extrinsic(named), T(named.T_parent_child), a(frame_name(named.parent)), b(frame_name(named.child)) {
  if (!T.translation.allFinite() || !T.rotation.coeffs().allFinite())
    throw Error("no extrinsic of " + b + " in " + a + " to write: its values are not finite");
  if (a == b)
    throw Error("no extrinsic to write: parent and child have the same name " + a +
                (named.parent == named.child ? std::string()
                                             : ", of '" + named.parent + "' and '" + named.child + "'"));
  direction = "pose of " + b + " in " + a + ": p_" + a + " = R * p_" + b + " + t";
  verdict = std::string(named.usable ? "" : "DO NOT USE, the motions contradict each other; ") +
            (named.certified ? "certified globally optimal" : "not certified") + ", from " +
            std::to_string(named.pairs) + " motion pairs";
  if (named.scale)
    verdict += "; lengths of " + frame_name(named.scale->sensor) + " multiplied by " +
               exact(named.scale->value) + (named.scale->certified ? "" : ", which is not certified");
}

std::string exact(double value) {
  std::string text;
  append_number(text, value == 0 ? 0.0 : value);
  // YAML 1.1 takes 1e-05 for a word, 1.0e-05 for a number
  if (const auto e = text.find('e'); e != std::string::npos && text.find('.') == std::string::npos)
    text.insert(e, ".0");
  return text;
}

Eigen::Vector4d wxyz(const Eigen::Quaterniond& q) {
  return {q.w(), q.x(), q.y(), q.z()};
}

Eigen::Vector4d xyzw(const Eigen::Quaterniond& q) {
  return {q.x(), q.y(), q.z(), q.w()};
}

Eigen::Matrix<double, 9, 1> rotation_rows(const Eigen::Quaterniond& q) {
  const Eigen::Matrix3d R = q.toRotationMatrix();
  Eigen::Matrix<double, 9, 1> rows;
  for (int i = 0; i < 9; ++i) rows[i] = R(i / 3, i % 3);
  return rows;
}

std::string matrix_rows(const Pose& T, const std::string& indent) {
  const Eigen::Matrix3d R = T.rotation.toRotationMatrix();
  std::string text;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector4d row(R(i, 0), R(i, 1), R(i, 2), T.translation(i));
    text += indent + "- [" + joined(row, ", ") + "]\n";
  }
  return text + indent + "- [0, 0, 0, 1]\n";
}

std::string frame_name(const std::string& name) {
  std::string safe;
  for (const char c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '_' || c == '-' || c == '.' || c == '/';
    // programs take a name that begins with - for an option
    safe += plain && !(c == '-' && safe.empty()) ? c : '_';
    if (safe.size() == 100) break;
  }
  return safe.empty() ? "unnamed" : safe;
}

std::string yaml_word(const std::string& name) {
  constexpr std::string_view special[] = {"y", "n", "yes", "no", "on", "off", "true", "false", "null"};
  std::string lower = name;
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  const bool letter =
      !lower.empty() && ((lower[0] >= 'a' && lower[0] <= 'z') || lower[0] == '_' || lower[0] == '/');
  const bool plain = letter && std::find(std::begin(special), std::end(special), lower) == std::end(special);
  return plain ? name : "\"" + name + "\"";
}

}  // namespace egocal::detail
