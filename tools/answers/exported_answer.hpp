// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// An answer as the extrinsic that is exported.
#pragma once

#include "answers/gathered_answers.hpp"
#include "egocal/io/extrinsic_text.hpp"

namespace egocal::tools {

/// Whether an answer, which the pair must have, may be used: no verdict is against it, none is about another
/// answer, and it is current. Live it is where its problem is sent: pairing repeats the problem once a
/// second, and solvers repeat their answer for hours when pairing hangs or is gone. An answer of a log is
/// always current.
bool may_be_used(const PairName& pair, const Answers& answers, bool live);

/// The extrinsic of a pair that has an answer. Warns on standard error of what is missing for it to be
/// certified, current and judged.
NamedExtrinsic exported_answer(const PairName& pair, const GatheredAnswers& gathered, bool live);

}  // namespace egocal::tools
