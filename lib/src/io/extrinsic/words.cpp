// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "io/extrinsic/words.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <string_view>
#include <utility>

#include "egocal/directions.hpp"
#include "egocal/error.hpp"
#include "io/number_text.hpp"
#include "io/text.hpp"

namespace egocal {

namespace {

/// Comments of every format end with their line, and a reason from a bus may hold anything.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  return text;
}

/// The sentence without its full stop: more follows.
std::string unfinished(std::string sentence) {
  if (sentence.ends_with('.')) sentence.pop_back();
  return sentence;
}

void add_part(std::string& text, const std::string& part) {
  text += (text.empty() || part.empty() ? "" : "; ") + part;
}

std::string not_shown(const NamedExtrinsic& extrinsic, bool mixed) {
  std::string text;
  for (const auto& [backing, words] : {std::pair{Backing::none, "NOT OBSERVABLE, not a measurement:"},
                                       std::pair{Backing::nominal, "NOT OBSERVABLE, from the nominal value:"},
                                       std::pair{Backing::planes, "from the ground planes:"}}) {
    std::string names;
    for (const std::string& name : detail::directions_with(extrinsic, backing)) names += " " + name;
    if (!names.empty()) add_part(text, words + names);
  }
  if (text.empty()) return text;
  if (mixed)
    text += ", in the axes of " + detail::frame_name(detail::backing_frame(extrinsic)) +
            ": several of these numbers hold a part of it";
  return text;
}

/// The frame of the sensor whose lengths are not multiplied.
const std::string& unscaled_frame(const NamedExtrinsic& named) {
  return named.scale->sensor == named.parent ? named.child : named.parent;
}

std::string lengths_in_words(const NamedExtrinsic& named) {
  return !named.scale || named.scale->metres
             ? "metres"
             : "lengths in the unit of " + detail::frame_name(unscaled_frame(named));
}

std::string verdict_in_words(const NamedExtrinsic& named, bool mixed) {
  std::string text;
  if (!named.usable)
    text = named.verdict == "contradictory" ? "DO NOT USE, the motions contradict each other" : "DO NOT USE";
  add_part(text,
           named.verdict.empty()
               ? "not judged: " + (named.reason.empty() ? "no verdict" : unfinished(one_line(named.reason)))
               : "verdict " + one_line(named.verdict) + (named.reason.empty() ? "" : ": ") +
                     unfinished(one_line(named.reason)));
  add_part(text, not_shown(named, mixed));
  add_part(text, std::string(named.certified ? "certified globally optimal" : "not certified") + ", from " +
                     std::to_string(named.pairs) + " motion pairs");
  if (named.scale)
    add_part(text, "lengths of " + detail::frame_name(named.scale->sensor) + " multiplied by " +
                       detail::exact(named.scale->value) +
                       (named.scale->changes ? ", the mean of a scale that changes along the drive" : "") +
                       (named.scale->certified ? "" : ", which is not certified") +
                       (std::isfinite(named.scale->stddev) ? "" : ", which is NOT OBSERVABLE"));
  if (named.scale && !named.scale->metres) {
    const std::string unit = detail::frame_name(unscaled_frame(named));
    add_part(text,
             "the translation is in the unit of " + unit + ", metres only if " + unit + " measures metres");
  }
  return text;
}

}  // namespace

std::string not_shown_in_words(const NamedExtrinsic& extrinsic) {
  return not_shown(extrinsic, false);
}

}  // namespace egocal

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
  lengths = lengths_in_words(named);
  const bool turned = !named.backing_frame.empty() && named.backing_frame != named.parent;
  verdict = verdict_in_words(named, turned);
  verdict_of_inverse = verdict_in_words(named, true);
}

std::array<Backing, 6> backing_of(const NamedExtrinsic& extrinsic) {
  if (extrinsic.backing) return *extrinsic.backing;
  std::array<Backing, 6> backing{};
  if (!extrinsic.stddev) return backing;
  for (std::size_t i = 0; i < backing.size(); ++i)
    backing[i] = std::isfinite((*extrinsic.stddev)[i]) ? Backing::motions : Backing::none;
  return backing;
}

const std::string& backing_frame(const NamedExtrinsic& extrinsic) {
  return extrinsic.backing_frame.empty() ? extrinsic.parent : extrinsic.backing_frame;
}

std::vector<std::string> directions_with(const NamedExtrinsic& extrinsic, Backing backing) {
  const std::array<Backing, 6> all = backing_of(extrinsic);
  std::vector<std::string> directions;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all[i] == backing) directions.emplace_back(direction_names[i]);
  return directions;
}

std::vector<std::string> not_observable(const NamedExtrinsic& extrinsic) {
  std::vector<std::string> directions = directions_with(extrinsic, Backing::none);
  for (std::string& name : directions_with(extrinsic, Backing::nominal))
    directions.push_back(std::move(name));
  return directions;
}

std::string in_quotes(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    char escape[8] = "";
    if (c == '"' || c == '\\')
      result += '\\';
    else if (byte < 0x20 || byte == 0x7f)
      std::snprintf(escape, sizeof escape, "\\u%04x", byte);
    result += *escape ? std::string(escape) : std::string(1, byte < 0x80 ? c : '?');
  }
  return result + "\"";
}

std::string list_in_quotes(const std::vector<std::string>& words) {
  std::string text = "[";
  for (const std::string& word : words) text += (text.size() > 1 ? ", " : "") + in_quotes(word);
  return text + "]";
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
  for (char& c : lower) c = detail::lower_case(c);
  const bool letter =
      !lower.empty() && ((lower[0] >= 'a' && lower[0] <= 'z') || lower[0] == '_' || lower[0] == '/');
  const bool plain = letter && std::find(std::begin(special), std::end(special), lower) == std::end(special);
  return plain ? name : "\"" + name + "\"";
}

}  // namespace egocal::detail
