// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <limits>

#include "egocal/monitor/text.hpp"

namespace egocal::monitor::test_text {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Text, NumbersForPeople) {
  constexpr Charset a = Charset::ascii, u = Charset::unicode;
  EXPECT_EQ(number(12.345, 2, a), "12.35");
  EXPECT_EQ(number(-0.001, 2, a), "0.00") << "never a negative zero";
  EXPECT_EQ(number(-0.0, 0, a), "0");
  EXPECT_EQ(number(-0.01, 2, a), "-0.01");
  EXPECT_EQ(number(not_a_number, 2, a), "-");
  EXPECT_EQ(number(infinity, 2, a), "inf");
  EXPECT_EQ(number(-infinity, 2, u), "-∞");
  EXPECT_EQ(number(1e300, 2, a), "1.0e+300");
  EXPECT_EQ(compact(0, a), "0");
  EXPECT_EQ(compact(0.01234, a), "0.0123");
  EXPECT_EQ(compact(0.2, a), "0.200");
  EXPECT_EQ(compact(1.5, a), "1.50");
  EXPECT_EQ(compact(123.4, a), "123");
  EXPECT_EQ(compact(1.2e-9, a), "1.2e-09");
  EXPECT_EQ(compact(not_a_number, a), "-");
}

TEST(Text, TimesForPeople) {
  constexpr Charset a = Charset::ascii;
  EXPECT_EQ(duration(5.21e-6, a), "5.2 us");
  EXPECT_EQ(duration(5.21e-6, Charset::unicode), "5.2 µs");
  EXPECT_EQ(duration(3.1e-4, a), "310 us");
  EXPECT_EQ(duration(9.999e-4, a), "1.0 ms") << "not 1000 us";
  EXPECT_EQ(duration(1.4e-3, a), "1.4 ms");
  EXPECT_EQ(duration(2, a), "2.0 s");
  EXPECT_EQ(duration(-1e-9, a), "-");
  EXPECT_EQ(duration(not_a_number, a), "-");
  EXPECT_EQ(duration(infinity, a), "long");
  EXPECT_EQ(age(0.2), "now");
  EXPECT_EQ(age(3.4), "3 s");
  EXPECT_EQ(age(300), "5 min");
  EXPECT_EQ(age(7200), "2 h");
  EXPECT_EQ(age(1e9), "days");
  EXPECT_EQ(age(-5), "-");
  EXPECT_EQ(age(not_a_number), "-");
  EXPECT_EQ(count(99999), "99999");
  EXPECT_EQ(count(123456), "123k");
  EXPECT_EQ(count(4'500'000), "4.5M");
  EXPECT_EQ(count(-5), "-5");
  EXPECT_EQ(count(std::numeric_limits<std::int64_t>::min()), "-9.2e+18");
  EXPECT_EQ(clock_time(3'661'000'000, 0), "01:01:01");
  EXPECT_EQ(clock_time(0, -3600), "23:00:00");
  for (std::int64_t extreme :
       {std::numeric_limits<std::int64_t>::min(), std::numeric_limits<std::int64_t>::max()})
    EXPECT_EQ(clock_time(extreme, 50400).size(), 8u);
}

TEST(Text, NamesFromOutsideAreMadeSafe) {
  EXPECT_EQ(clean("front_lidar-2"), "front_lidar-2");
  EXPECT_EQ(clean("Räder µ"), "Räder µ");
  EXPECT_EQ(clean("\x1b[31m\r\n\t\x7f"), "?[31m????");
  EXPECT_EQ(clean("\xc2\x9b"
                  "31m"),
            "?31m")
      << "the one-byte escape of eight-bit terminals";
  EXPECT_EQ(clean("a\xff"
                  "b\xc3"),
            "a?b?")
      << "broken UTF-8";
  EXPECT_EQ(clean("\xc0\x9b"
                  "x"),
            "??x")
      << "an overlong escape";
  EXPECT_EQ(clean("\xe2\x80\xae"
                  "abc"),
            "?abc")
      << "right to left";
  EXPECT_EQ(clean("e\xcc\x81"), "e?") << "combining marks take no cell";
  EXPECT_EQ(clean("\xe4\xb8\xad"), "?") << "wide ones take two";
  EXPECT_EQ(clean("\xf0\x9f\x98\x80"), "?");
  EXPECT_EQ(clean(std::string_view("a\0b", 3)), "a?b");
  EXPECT_EQ(clean(std::string(200, 'W'), 10), "WWWWWWWWW~");
  EXPECT_EQ(clean("exactly", 7), "exactly");
  EXPECT_EQ(clean("anything", 0), "");
}

TEST(Text, NamesThatBeginAlikeAreCutInTheMiddle) {
  EXPECT_EQ(clean_name("radar_rear", 10), "radar_rear");
  EXPECT_EQ(clean_name("radar_front_long_range", 8), "rad~ange");
  EXPECT_EQ(clean_name("radar_rear", 8), "rad~rear");
  EXPECT_EQ(clean_name("kam\x1b"
                       "era",
                       6),
            "ka~era");
  for (std::size_t max = 0; max < 12; ++max)
    EXPECT_LE(width_of(clean_name("radar_rear", max)), static_cast<int>(max));
}

TEST(Text, LongLinesAreWrappedAtBlanks) {
  EXPECT_EQ(wrapped("one two three four", 9, 2), (std::vector<std::string>{"one two", "  three", "  four"}));
  EXPECT_EQ(wrapped("short", 9, 2), std::vector<std::string>{"short"});
  EXPECT_TRUE(wrapped("", 9, 2).empty());
  EXPECT_TRUE(wrapped("text", 0, 2).empty());
  for (std::size_t max = 1; max < 30; ++max) {
    std::string all;
    for (const std::string& line : wrapped(std::string(60, 'x') + " and more", max, 4)) {
      EXPECT_LE(width_of(line), static_cast<int>(max));
      for (const char c : line)
        if (c != ' ') all += c;
    }
    EXPECT_EQ(all, std::string(60, 'x') + "andmore") << max;
  }
}

TEST(Text, PathsLoseTheirFoldersWhereThereIsNoRoom) {
  const std::string full = "/var/lib/egocal/a/long/way/car.state: cannot be written: No space left on device";
  EXPECT_EQ(without_folders(full, 200), full);
  EXPECT_EQ(without_folders(full, 60), "~/car.state: cannot be written: No space left on device");
  EXPECT_EQ(without_folders("copies /a/b/c to /d/e/f", 22), "copies ~/c to /d/e/f")
      << "no more than is needed";
  EXPECT_EQ(without_folders("copies /a/b/c to /d/e/f", 5), "copies ~/c to ~/f");
  EXPECT_EQ(without_folders("/ // /x //y : /", 3), "/ // /x //y : /") << "nothing is gained";
  EXPECT_EQ(without_folders("", 0), "");
}

TEST(Text, PaddedToTheCell) {
  EXPECT_EQ(pad_right("ab", 4), "ab  ");
  EXPECT_EQ(pad_left("±1", 4), "  ±1");
  EXPECT_EQ(pad_right("±±±", 2), "±±");
  EXPECT_EQ(pad_left("abc", 0), "");
  EXPECT_EQ(pad_left("abc", -3), "");
  EXPECT_EQ(width_of("→ ±°"), 4);
}

// 4294967396 is 2^32 + 100, and was 100
TEST(Text, SizesAreNumbersOfCells) {
  const std::optional<Size> size = size_from_text("100x30");
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width, 100);
  EXPECT_EQ(size->height, 30);
  EXPECT_TRUE(size_from_text("1x1000"));
  for (const char* text :
       {"4294967396x30", "100x4294967326", "99999999999999999999x30", "0x30", "100x0", "-1x30", "1001x30",
        "100x1001", "100x30x", "100x30 ", " 100x30", "100x", "x30", "100", "", "+1x1"})
    EXPECT_FALSE(size_from_text(text)) << text;
}

TEST(Text, AsciiIsAscii) {
  const Symbols& s = symbols(Charset::ascii);
  for (const char* word : {s.arrow, s.plus_minus, s.degree, s.micro, s.yes, s.no, s.alive, s.gone, s.cursor,
                           s.dot, s.line, s.bar_full, s.bar_empty, s.infinite})
    for (const char* c = word; *c; ++c) EXPECT_LT(static_cast<unsigned char>(*c), 0x7f);
}

}  // namespace egocal::monitor::test_text
