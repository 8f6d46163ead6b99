// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <vector>

namespace egocal::cli {

/// A finite number in decimal digits; nothing otherwise.
std::optional<double> finite_number(const std::string& text);

/// The number as people write it: 10000000, 0.001, 1e+09.
std::string shortest(double value);

/// "flat, rough or free".
std::string alternatives(const std::vector<std::string>& words);

/// Refuses an empty value: `--goal "$GOAL"` in a shell without GOAL is no goal. Also refuses the name of an
/// option, as in `--out --json`, where the value was forgotten.
CLI::Validator a_value();

CLI::Validator any_number();

/// Refuses the value of a flag: `--json=3x` is not the flag. CLI11 hands on "true" where nothing is given,
/// and --json=false is as good as no flag.
CLI::Validator no_value();

/// Accepts decimal digits only: CLI11 takes 010 for eight, and -1 for the largest unsigned number.
template <class Integer>
CLI::Validator whole_number() {
  return CLI::Validator(
      [](std::string& text) {
        Integer value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        const std::size_t digits = text.find_first_not_of('-');
        const bool octal = digits != std::string::npos && text[digits] == '0' && text.size() > digits + 1;
        if (error == std::errc() && end == text.data() + text.size() && !octal) return std::string();
        std::string expected =
            std::is_signed_v<Integer> ? "expected a whole number" : "expected a whole number from 0 up";
        if (error == std::errc::result_out_of_range)
          expected += " of at most " + std::to_string(std::numeric_limits<Integer>::max());
        return expected + ", got '" + text + "'";
      },
      "");
}

template <class Value>
struct OfOptional {
  using type = Value;
};
template <class Value>
struct OfOptional<std::optional<Value>> {
  using type = Value;
};
template <class Value>
struct OfOptional<std::vector<Value>> {
  using type = Value;
};

/// What each text for a variable of this type must be.
template <class Variable>
void check_type(CLI::Option& option) {
  using Value = typename OfOptional<Variable>::type;
  option.check(a_value());
  if constexpr (std::is_floating_point_v<Value>)
    option.check(any_number());
  else if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>)
    option.check(whole_number<Value>());
}

}  // namespace egocal::cli
