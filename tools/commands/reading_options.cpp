// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "commands/reading_options.hpp"

namespace egocal::tools {

namespace {

ReadOptions either(const ReadOptions& own, const ReadOptions& common) {
  ReadOptions result = common;
  if (!own.times_file.empty()) result.times_file = own.times_file;
  if (!own.columns.empty()) result.columns = own.columns;
  result.strict = own.strict || common.strict;
  return result;
}

}  // namespace

ReadOptions ReadingOptions::of_a() const {
  return either(a, both);
}

ReadOptions ReadingOptions::of_b() const {
  return either(b, both);
}

void refuse_reading_options(const ReadingOptions& options, const char* instead) {
  const auto refuse = [&](bool given, const char* option) {
    if (given) throw cli::UsageError(std::string(option) + ": does not go with " + instead);
  };
  for (const ReadOptions* one : {&options.both, &options.a, &options.b}) {
    refuse(!one->times_file.empty(), "--times");
    refuse(!one->columns.empty(), "--columns");
    refuse(one->rate > 0, "--rate");
    refuse(one->strict, "--strict");
  }
}

void add_reading_options(cli::App command, ReadOptions& options) {
  command.add_option("--times", options.times_file, "times of poses that have none (KITTI), one a line [s]");
  command.add_option("--columns", options.columns,
                     "names of the columns of tables: t,x,y,z,qx,qy,qz,qw or yaw, roll, pitch; units as "
                     "yaw[deg]; - for others");
  command.add_option("--rate", options.rate, "of poses without times [Hz; 10]")
      .check(cli::Check::above_zero(1e6, 1e-3));
  command.add_flag(
      "--strict", options.strict,
      "refuse what is repaired or passed over otherwise: poses out of order, repeated times, rows and "
      "messages that hold no pose, damage, and recordings that contradict themselves");
}

void add_reading_options(cli::App command, ReadingOptions& options) {
  add_reading_options(command, options.both);
  command.add_option("--times-a", options.a.times_file, "times of A alone");
  command.add_option("--times-b", options.b.times_file, "times of B alone");
  command.add_option("--columns-a", options.a.columns, "columns of table A alone");
  command.add_option("--columns-b", options.b.columns, "columns of table B alone");
}

}  // namespace egocal::tools
