// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// Readings of the two files that are tried, and whether one explains the motions better.
#pragma once

#include <string>
#include <vector>

#include "diagnosis/explanations/explanations.hpp"

namespace egocal::detail {

struct Candidate {
  const char* code;
  PoseReading a, b;
};

/// The mistakes that have an option as their cure, simplest first.
std::vector<Candidate> common_mistakes();
/// Two of them in one stream: rows of COLMAP (w x y z, world-to-camera) that were copied into another file.
std::vector<Candidate> combined_mistakes();

/// An explanation by motions of `stride` instants.
Explanation explained(const Evidence& evidence, int stride, const char* code, const PoseReading& a,
                      const PoseReading& b, const DiagnosisOptions& options);
/// An explanation by the motions that are compared.
Explanation explained(const Evidence& evidence, const char* code, const PoseReading& a, const PoseReading& b,
                      const DiagnosisOptions& options);
/// The explanation with a free scale of b.
Explanation with_scale(const Explanation& explanation, const DiagnosisOptions& options);

/// What leaves more than a part of the typical motion unexplained (DiagnosisOptions::explains) explains
/// nothing.
bool explains(const Explained& explained, const DiagnosisOptions& options);

/// Better by `sigmas` standard deviations, or by nearly all that the blocks can show where those are few.
bool better(const Comparison& comparison, double least_log_ratio, double sigmas);
/// Clearly better by the stated test.
bool better(const Comparison& comparison, double least_log_ratio, const DiagnosisOptions& options);
/// One number more explains a little of any noise: it must be clear beyond what few blocks can show, or gain
/// much.
bool number_explains(const Comparison& comparison, const DiagnosisOptions& options);

/// A finding that is not worded yet.
Finding finding_of(std::string code, const Explained& explained, const Comparison& comparison, bool certain);
Finding finding_of(const Explanation& explanation, const Comparison& comparison, bool certain);

}  // namespace egocal::detail
