// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/pair/samples.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "egocal/error.hpp"
#include "egocal/in_words.hpp"
#include "egocal/pairing/match_rows.hpp"
#include "egocal/samples/named_samples.hpp"
#include "offline/pair/motions.hpp"
#include "offline/reading/poses_as_given.hpp"

namespace egocal::tools {

namespace {

SampleOptions options_of(const SolveRequest& request) {
  const CalibrationOptions& calibration = request.calibration;
  SampleOptions options;
  options.read_a = calibration.read_a;
  options.read_b = calibration.read_b;
  if (request.samples->eye_to_hand) options.read_a.invert = !options.read_a.invert;
  (calibration.scale_side == Side::a ? options.read_a : options.read_b).scale = calibration.scale;
  options.prior = calibration.pairing.prior;
  options.diagnosis = calibration.diagnosis;
  return options;
}

struct BothLists {
  PosesAsGiven a, b;
  std::vector<std::string> warnings;
};

BothLists read_lists(const MotionSource& source) {
  BothLists lists;
  if (source.log.empty()) {
    with_times_of_both(source, [&] {
      lists.a = read_as_given(source.a, source.reading_a);
      lists.b = read_as_given(source.b, source.reading_b);
    });
  } else {
    Motions motions = read_motions(source);
    lists.a.list = as_rows(motions.a);
    lists.b.list = as_rows(motions.b);
    lists.warnings = std::move(motions.warnings);
  }
  for (const PosesAsGiven* list : {&lists.a, &lists.b})
    lists.warnings.insert(lists.warnings.end(), list->notes.begin(), list->notes.end());
  return lists;
}

/// What must be known of how the rows were put together.
std::vector<std::string> matching_in_words(const BothLists& lists, const MatchedRows& rows) {
  std::vector<std::string> words;
  if (rows.matched.by_stamp) {
    for (const PosesAsGiven* list : {&lists.a, &lists.b})
      words.insert(words.end(), list->repairs.begin(), list->repairs.end());
    if (rows.times_of_b != 1)
      words.push_back(fmt::format("the times of b are multiplied by {:g}: they agree with those of a then",
                                  rows.times_of_b));
  } else {
    words.push_back(std::string(rows.stamps_repeat ? "stamps are equal" : "the stamps do not agree") +
                    ": row i of a belongs to row i of b");
  }
  if (rows.matched.without_partner > 0)
    words.push_back("no partner, not used: " + counted(rows.matched.without_partner, "row"));
  return words;
}

SampleNames names_of(const MatchedSamples& matched) {
  SampleNames names;
  names.kind = "row";
  for (std::size_t i = 0; i < matched.samples.size(); ++i) names.of.push_back(rows_in_words(matched, i));
  if (!std::is_sorted(matched.rows_a.begin(), matched.rows_a.end()))
    names.order = "in the order of the times";
  return names;
}

}  // namespace

std::string rows_in_words(const MatchedSamples& matched, std::size_t sample) {
  const std::size_t a = matched.rows_a[sample] + 1, b = matched.rows_b[sample] + 1;
  return a == b ? std::to_string(a) : fmt::format("{} ({} of b)", a, b);
}

void answer_samples(const SolveRequest& request, SolveResult& result) {
  const BothLists lists = read_lists(request.source);
  result.warnings = lists.warnings;
  result.scale_side = request.calibration.scale_side;
  result.a_has_scale = lists.a.has_scale;
  result.b_has_scale = lists.b.has_scale;
  try {
    const MatchedRows rows = match_rows(lists.a.list, lists.b.list);
    for (std::string& text : matching_in_words(lists, rows)) result.warnings.push_back(std::move(text));
    result.matched = rows.matched;
    result.samples =
        calibrate_named_samples(result.matched.samples, options_of(request), names_of(result.matched));
  } catch (const Error& error) {
    throw Error(request.source.a + ", " + request.source.b + ": " + error.what());
  }
  result.calibration = result.samples->calibration;
  result.calibration.scale_applied = request.calibration.scale;
  result.method = "dual";
  result.eye_to_hand = request.samples->eye_to_hand;
  const SampleCalibration& samples = *result.samples;
  if (samples.repeated > 0)
    result.warnings.push_back("repeat another row exactly, count once: " + counted(samples.repeated, "row"));
  if (samples.different > 0 && samples.different + samples.repeated < samples.residuals.size())
    result.warnings.push_back("samples that share a pose count as one: " +
                              counted(samples.different, "different sample"));
}

}  // namespace egocal::tools
