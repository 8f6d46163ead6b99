// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/common/beside.hpp"

#include <exception>
#include <system_error>
#include <thread>

namespace egocal::tools {

namespace {

std::exception_ptr thrown_by(const std::function<void()>& work) {
  try {
    work();
  } catch (...) {
    return std::current_exception();
  }
  return nullptr;
}

}  // namespace

void at_the_same_time(const std::function<void()>& first, const std::function<void()>& second) {
  std::exception_ptr of_first, of_second;
  std::thread other;
  try {
    other = std::thread([&] { of_second = thrown_by(second); });
  } catch (const std::system_error&) {
    // no thread to be had, as under `ulimit -u`
  }
  of_first = thrown_by(first);
  if (other.joinable())
    other.join();
  else if (!of_first)
    of_second = thrown_by(second);
  for (const std::exception_ptr& one : {of_first, of_second})
    if (one) std::rethrow_exception(one);
}

void one_after_the_other(const std::function<void()>& first, const std::function<void()>& second) {
  first();
  second();
}

}  // namespace egocal::tools
