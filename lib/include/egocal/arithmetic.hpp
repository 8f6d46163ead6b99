// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

// Every bound here is proven for IEEE 754 arithmetic as written. Flags that let a compiler assume that NaN
// does not occur, or that regroup sums, void the proofs: wrong answers would be certified. Such flags in a
// user's own program do so too, as they also change how the processor treats the smallest numbers.
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && __FINITE_MATH_ONLY__) || \
    defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(_M_FP_FAST)
#error \
    "egocal: compile without -ffast-math, -Ofast and their parts: under them a wrong answer would be certified"
#endif
