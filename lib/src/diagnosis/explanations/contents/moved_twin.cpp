// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "diagnosis/explanations/contents/moved_twin.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "diagnosis/explanations/common_mistakes.hpp"
#include "diagnosis/explanations/contents/forward.hpp"
#include "diagnosis/mount/division.hpp"
#include "diagnosis/words/wording.hpp"
#include "egocal/diagnosis/finding_words.hpp"

namespace egocal::detail {

namespace {

bool inverts_one_stream(const Finding& finding) {
  return finding.code == "inverted_a" || finding.code == "inverted_b";
}

/// The explanation with one stream alone inverted. code: inverted_a or inverted_b.
Explanation with_inverted(const Evidence& evidence, const std::string& code,
                          const DiagnosisOptions& options) {
  PoseReading inverted;
  inverted.invert = true;
  return code == "inverted_a" ? explained(evidence, "inverted_a", inverted, {}, options)
                              : explained(evidence, "inverted_b", {}, inverted, options);
}

/// loss_in_metres() from one answer to the two of a division of the same drive.
double loss_of_division(const Explained& one, const Motions& motions, const Division& division) {
  const std::size_t n = motions.all.size();
  const auto loss = [&](std::size_t from, std::size_t to, const RobustFit& fit) {
    Explained before{part_of(one.motions, from, to), {}};
    before.fit = evaluated(before.motions, one.fit.T);
    return loss_in_metres(before, {part_of(motions, from, to), fit}) * static_cast<double>(to - from);
  };
  return (loss(0, division.at, division.before) + loss(division.at, n, division.after)) /
         static_cast<double>(n);
}

struct MovedTwin {
  Finding finding;
  bool better = false;  ///< than the named inversion, in both measures
};

/// The twin of an inversion that is named, with a move, where it fits as well.
std::optional<MovedTwin> moved_twin(const Evidence& evidence, const Explanation& named,
                                    const DiagnosisOptions& options) {
  const MovedTwinOptions tuning;
  const bool of_a = named.code == "inverted_a";
  const Explanation twin = with_inverted(evidence, of_a ? "inverted_b" : "inverted_a", options);
  const Motions& motions = twin.explained.motions;
  if (motions.all.empty() || motions.all.size() != named.explained.motions.all.size()) return std::nullopt;
  // a vehicle that travels forward under one reading alone shows it (best_reading.cpp)
  if (forward(heading(named.explained.motions), options.heading) &&
      !forward(heading(motions), options.heading))
    return std::nullopt;
  const std::size_t margin = tuning.least_blocks * motions.all.size() / motions.blocks;
  const std::optional<Division> division =
      best_division(motions, twin.explained.fit, margin, tuning.places, options.fit);
  if (!division) return std::nullopt;
  const Explained parts = in_two(motions, *division);
  if (!explains(parts, options) || compare(twin.explained, parts).gain < tuning.gain) return std::nullopt;
  const double gain = compare(named.explained, parts).gain;
  const double loss = loss_of_division(named.explained, motions, *division);
  if (gain < -options.gain || loss > options.gain) return std::nullopt;
  MovedTwin result;
  result.better = gain > 0 && loss < 0;
  Finding& finding = result.finding;
  finding.code = twin.code;
  finding.improvement = std::exp(compare(evidence.given.explained, parts).gain);
  finding.T_a_b = to_pose(division->after.T);
  finding = worded_reading(std::move(finding), twin.read_a, twin.read_b);
  say(finding, finding.words.claim, finding.words.cure,
      format(
          ": with a mounting that moved about %.1f s after the start the motions fit as well. With the wrong "
          "stream inverted a move does not show.",
          motions.all[std::min(division->at, motions.all.size() - 1)].time));
  return result;
}

}  // namespace

void doubt_inversion(const Evidence& evidence, const DiagnosisOptions& options,
                     std::vector<Finding>& findings) {
  // with a scale, a clock, or in a part of the drive there would be three mistakes
  if (findings.empty() || !findings.front().words.scope.empty() ||
      !std::all_of(findings.begin(), findings.end(), inverts_one_stream))
    return;
  const Explanation named = with_inverted(evidence, findings.front().code, options);
  std::optional<MovedTwin> twin = moved_twin(evidence, named, options);
  if (!twin) return;
  findings.resize(1);
  if (findings.front().certain)
    findings.front() =
        worded_reading(finding_of(named, compare(evidence.given.explained, named.explained), false),
                       named.read_a, named.read_b);
  findings.insert(twin->better ? findings.begin() : findings.end(), std::move(twin->finding));
}

}  // namespace egocal::detail
