// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What explains motions that no reading, scale or clock does.
#pragma once

#include <vector>

#include "diagnosis/explanations/explanations.hpp"
#include "diagnosis/explanations/replacing.hpp"
#include "diagnosis/verdict/judge.hpp"

namespace egocal::detail {

/// What is left where no reading, scale or clock explains the motions. misfit: loses what is noise.
void look_further(const PairingOptions& pairing, const Evidence& evidence, const Answered& answered,
                  const Fit& fit, const DiagnosisOptions& options, WrongStream& wrong_stream, Misfit& misfit,
                  std::vector<Finding>& findings);

}  // namespace egocal::detail
