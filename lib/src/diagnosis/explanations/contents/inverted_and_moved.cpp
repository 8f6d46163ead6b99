// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/contents/inverted_and_moved.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/contents/forward.hpp"
#include "diagnosis/mount/in_parts.hpp"
#include "diagnosis/mount/mount.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

/// loss_in_metres() from the answer to all motions as given to that of a part of them inverted, there.
double loss_of_part(const Explained& given, const Motions& inverted, std::size_t from, std::size_t to,
                    const DiagnosisOptions& options) {
  Explained x{part_of(given.motions, from, to), {}}, y{part_of(inverted, from, to), {}};
  x.fit = evaluated(x.motions, given.fit.T);
  y.fit = robust_fit(y.motions, options.fit);
  return loss_in_metres(x, y);
}

/// loss_of_part() of all parts between the moves, together.
double loss_of_parts(const Explained& given, const Motions& inverted, const std::vector<Finding>& moves,
                     const DiagnosisOptions& options) {
  const std::vector<std::size_t> bounds = bounds_of_parts(inverted, moves);
  double sum = 0;
  for (std::size_t k = 0; k + 1 < bounds.size(); ++k)
    sum += loss_of_part(given, inverted, bounds[k], bounds[k + 1], options) *
           static_cast<double>(bounds[k + 1] - bounds[k]);
  return sum / static_cast<double>(bounds.back());
}

/// Whether quarters of the drive but one, in which the mounting may have changed, fit as well inverted. An
/// odometry that drifts does not even there; a first look, as moves take as long as all else to find.
bool quarters_fit(const Explained& given, const Motions& inverted, const DiagnosisOptions& options) {
  constexpr std::size_t quarters = 4;  // least in which one that holds the move leaves most of the drive
  const std::size_t n = inverted.all.size();
  if (n < quarters * options.motions.least) return false;
  std::size_t worse = 0;
  for (std::size_t k = 0; k < quarters && worse < 2; ++k)
    if (loss_of_part(given, inverted, k * n / quarters, (k + 1) * n / quarters, options) > options.gain)
      ++worse;
  return worse < 2;
}

}  // namespace

std::optional<Finding> inverted_and_moved(const Evidence& evidence, const Answered& answered,
                                          const DiagnosisOptions& options) {
  const Explained& given = evidence.given.explained;
  if (!explains(given, options)) return std::nullopt;
  PoseReading inverted;
  inverted.invert = true;
  const Motions motions = motions_of(evidence.instants, inverted, inverted, evidence.stride,
                                     options.motions.most, options.motions);
  // what travels forward, or along one line, as given alone is not inverted (as in both_inverted())
  const Heading as_given = heading(given.motions), as_inverted = heading(motions);
  if ((forward(as_given, options.heading) && !forward(as_inverted, options.heading)) ||
      (along_one_line(as_given, options.heading) && !along_one_line(as_inverted, options.heading)))
    return std::nullopt;
  if (motions.all.size() != given.motions.all.size() || !quarters_fit(given, motions, options))
    return std::nullopt;
  const std::vector<Finding> moves = moved_mount(evidence.instants, answered, options, inverted).findings;
  // what an odometry drifts by looks like a mounting that creeps
  const auto slow = [](const Finding& one) { return one.change == MountingChange::slowly; };
  if (moves.empty() || !one_move(moves) || std::any_of(moves.begin(), moves.end(), slow)) return std::nullopt;
  const Explained parts = in_parts(motions, moves, options);
  const double gain = compare(given, parts).gain, loss = loss_of_parts(given, motions, moves, options);
  if (!explains(parts, options) || gain < -options.gain || loss > options.gain) return std::nullopt;
  Finding finding;
  finding.code = "inverted_both";
  finding.improvement = std::exp(std::min(gain, -loss));
  finding.time = moves.front().time;
  finding.T_a_b = moves.front().T_a_b;
  finding = worded_reading(std::move(finding), inverted, inverted);
  say(finding, finding.words.claim, finding.words.cure,
      format(
          ", the mounting changed about %.1f s after the start, and the answer is another one; the motions "
          "cannot tell.",
          *moves.front().time));
  return finding;
}

}  // namespace egocal::detail
