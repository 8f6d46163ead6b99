// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "supervision/interruptions.hpp"

#include <unistd.h>

#include <cstddef>
#include <iterator>

namespace egocal::tools {

namespace {

volatile std::sig_atomic_t self = 0;  // the process that a user interrupts, for handlers

void handle(int number, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(number, &action, nullptr);
}

// in a signal handler: only what is safe there
void end_before_the_start(int) {
  _exit(0);
}

void end_before_the_log(int) {
  if (getpid() != self) _exit(0);  // the process that listens is ended by us
  constexpr char text[] = "egocal up: ended before the log was played: nothing was calibrated\n";
  if (write(STDERR_FILENO, text, sizeof text - 1) < 0) _exit(1);
  _exit(1);
}

}  // namespace

Interruptions::Interruptions(bool player) {
  self = getpid();
  sigemptyset(&signals_);
  for (std::size_t i = 0; i < std::size(numbers_); ++i) {
    sigaddset(&signals_, numbers_[i]);
    sigaction(numbers_[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN)
      handle(numbers_[i], player ? end_before_the_log : end_before_the_start);
  }
  handle(SIGPIPE, SIG_IGN);
}

void Interruptions::hold() {
  sigprocmask(SIG_BLOCK, &signals_, &mask_);
  held_ = true;
}

void Interruptions::release() {
  if (!held_) return;
  held_ = false;
  for (std::size_t i = 0; i < std::size(numbers_); ++i) sigaction(numbers_[i], &before_[i], nullptr);
  sigprocmask(SIG_SETMASK, &mask_, nullptr);
}

}  // namespace egocal::tools
