// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// curses and terminfo without those of their macros that have names of ours.
#pragma once

#define NCURSES_WIDECHAR 1
#include <curses.h>
#include <term.h>

#undef lines
#undef columns
#undef tab
#undef key
