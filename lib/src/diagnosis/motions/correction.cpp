// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/motions/correction.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/motions/robust_fit.hpp"
#include "egocal/microseconds.hpp"
#include "egocal/statistics/median.hpp"

namespace egocal::detail {

namespace {

/// Medians of the squared residuals, also in parts of the motions.
struct Typical {
  double rotation = 0, translation = 0, rotation_part = 0, translation_part = 0;
};

Typical typical_of(const Stretch& stretch) {
  const Pose T = to_pose(stretch.T_a_b);
  std::vector<double> rotations, translations, rotation_parts, translation_parts;
  const auto square = [](double value) { return value * value; };
  for (const Motion& motion : stretch.motions.all) {
    const Residual residual = residual_at(motion, T);
    rotations.push_back(square(residual.rotation));
    translations.push_back(square(residual.translation));
    // what is wrong with one of them makes it longer
    const double angle = std::min(motion.angle_a, motion.angle_b),
                 length = std::min(motion.t_a.norm(), motion.t_b.norm());
    if (angle > 0) rotation_parts.push_back(square(residual.rotation / angle));
    if (length > 0) translation_parts.push_back(square(residual.translation / length));
  }
  const auto typical = [](std::vector<double> squares) {
    return squares.empty() ? 0.0 : median(std::move(squares));
  };
  return {typical(std::move(rotations)), typical(std::move(translations)), typical(std::move(rotation_parts)),
          typical(std::move(translation_parts))};
}

/// The motions of a part of the time, by their ends.
std::vector<MotionPair> within(const std::vector<MotionPair>& pairs, std::int64_t from_us,
                               std::int64_t to_us) {
  std::vector<MotionPair> result;
  for (const MotionPair& pair : pairs)
    if (pair.begin_us >= from_us && pair.end_us <= to_us) result.push_back(pair);
  return result;
}

/// For each stretch between the moves, whether it is spoiled by a correction: no mounting explains it and it
/// is as short as two corrections, or its own answer does not and a robust one does. Compared with those that
/// are long enough: a short one is explained by chance.
std::vector<bool> spoiled_stretches(const std::vector<MotionPair>& pairs, const std::vector<Move>& moves,
                                    const std::vector<std::int64_t>& times_us,
                                    const CorrectionOptions& options) {
  struct Part {
    Stretch stretch;
    double seconds = 0;
  };
  std::vector<Part> parts;
  for (std::size_t k = 0; k <= moves.size(); ++k) {
    const std::int64_t from_us = k == 0 ? pairs.front().begin_us : times_us[k - 1],
                       to_us = k == moves.size() ? pairs.back().end_us : times_us[k];
    parts.push_back(
        {{motions_of(within(pairs, from_us, to_us)), k == 0 ? moves.front().before : moves[k - 1].after},
         to_seconds(to_us - from_us)});
  }
  std::vector<bool> spoiled;
  for (const Part& part : parts)
    spoiled.push_back(std::any_of(parts.begin(), parts.end(), [&](const Part& other) {
      if (other.seconds < options.seconds || !unexplained_beside(part.stretch, other.stretch, options))
        return false;
      if (part.seconds < 2 * options.seconds) return true;
      Motions both = other.stretch.motions;
      both.all.insert(both.all.end(), part.stretch.motions.all.begin(), part.stretch.motions.all.end());
      return !unexplained_beside({part.stretch.motions, robust_fit(both).T}, other.stretch, options);
    }));
  return spoiled;
}

}  // namespace

bool unexplained_beside(const Stretch& x, const Stretch& y, const CorrectionOptions& options) {
  if (x.motions.all.empty() || y.motions.all.empty()) return false;
  const Typical here = typical_of(x), other = typical_of(y);
  const auto worse = [&](double Typical::*size, double Typical::*part) {
    return here.*size > options.unexplained * other.*size && here.*part > options.unexplained * other.*part;
  };
  return worse(&Typical::rotation, &Typical::rotation_part) ||
         worse(&Typical::translation, &Typical::translation_part);
}

std::vector<Move> without_corrections(const std::vector<MotionPair>& pairs, const Problem& problem,
                                      std::vector<Move> moves, const CorrectionOptions& options) {
  if (pairs.empty() || moves.empty()) return moves;
  std::stable_sort(moves.begin(), moves.end(), [](const Move& x, const Move& y) { return x.time < y.time; });
  const std::int64_t left_out_us = to_microseconds(options.seconds);
  std::vector<std::int64_t> times_us;
  for (const Move& move : moves) times_us.push_back(pairs.front().begin_us + to_microseconds(move.time));
  const std::vector<bool> spoiled = spoiled_stretches(pairs, moves, times_us, options);
  std::vector<Move> kept;
  std::int64_t from_us = pairs.front().begin_us;
  for (std::size_t first = 0, end = 0; first < moves.size(); first = end) {
    // a correction may have a change at its begin and one at its end
    for (end = first + 1; end < moves.size() && times_us[end] - times_us[end - 1] < 2 * left_out_us;) ++end;
    const std::int64_t left_us = times_us[first] - left_out_us, right_us = times_us[end - 1] + left_out_us;
    const std::int64_t to_us = end < moves.size() ? times_us[end] - left_out_us : pairs.back().end_us;
    bool correction = std::any_of(spoiled.begin() + static_cast<std::ptrdiff_t>(first),
                                  spoiled.begin() + static_cast<std::ptrdiff_t>(end) + 1,
                                  [](bool stretch) { return stretch; });
    if (std::min(left_us - from_us, to_us - right_us) >= left_out_us) {
      std::vector<MotionPair> around = within(pairs, from_us, left_us);
      const std::vector<MotionPair> after = within(pairs, right_us, to_us);
      around.insert(around.end(), after.begin(), after.end());
      const std::optional<double> chance =
          chance_of_move(around, problem, MoveKind::bump, (left_us + right_us) / 2);
      if (chance) correction = *chance > options.chance;
    }
    if (!correction)
      kept.insert(kept.end(), moves.begin() + static_cast<std::ptrdiff_t>(first),
                  moves.begin() + static_cast<std::ptrdiff_t>(end));
    from_us = right_us;
  }
  return kept;
}

}  // namespace egocal::detail
