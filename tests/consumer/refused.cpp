// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause

// What main.cpp includes of the library and nothing of Eigen's that takes long to compile: the headers alone
// refuse flags.
#include "egocal/certificate/certificate.hpp"
#include "egocal/evaluation/errors.hpp"
#include "egocal/problem/problem.hpp"
#include "egocal/simulation/simulation.hpp"
#include "egocal/solvers/global.hpp"

int main() {}
