// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "values.hpp"

#include <cmath>
#include <cstdio>
#include <utility>

#include "advice.hpp"
#include "egocal/cli/cli.hpp"

namespace egocal::cli {

namespace {

constexpr const char* any_number_name = "number";

}  // namespace

std::optional<double> finite_number(const std::string& text) {
  const char* const end = text.data() + text.size();
  const char* const begin = text.data() + (text.rfind('+', 0) == 0 ? 1 : 0);
  double value = 0;
  const auto [behind, error] = std::from_chars(begin, end, value);
  if (error != std::errc() || behind != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::string shortest(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

std::string alternatives(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return text;
}

CLI::Validator a_value() {
  return CLI::Validator(
      [](std::string& text) -> std::string {
        if (text.empty()) return "expected a value, got ''; is a variable of the shell not set?";
        if (text.size() > 2 && text.starts_with("--"))
          return "expected a value, got the option '" + text + "'";
        return "";
      },
      "");
}

CLI::Validator no_value() {
  return CLI::Validator(
      [](std::string& text) {
        return text == "true" || text == "false" ? std::string() : "expected no value, got '" + text + "'";
      },
      "");
}

CLI::Validator any_number() {
  return CLI::Validator(
      [](std::string& text) {
        return finite_number(text) ? std::string() : "expected a number, got '" + text + "'";
      },
      "", any_number_name);
}

Check Check::one_of(std::vector<std::string> values) {
  Check check;
  check.kind_ = Kind::one_of;
  check.values_ = std::move(values);
  return check;
}

Check Check::range(double least, double most) {
  Check check;
  check.least_ = least;
  check.most_ = most;
  return check;
}

Check Check::not_negative() {
  Check check;
  check.kind_ = Kind::not_negative;
  return check;
}

Check Check::above_zero(double most, double least) {
  Check check;
  check.kind_ = Kind::above_zero;
  check.least_ = least;
  check.most_ = most;
  return check;
}

Option& Option::check(const Check& check) {
  // what is no finite number is in no range, whose message says more
  const auto add = [this](auto good, const std::string& expected, const std::string& description) {
    try {
      option_->get_validator(any_number_name)->active(false);
    } catch (const CLI::OptionNotFound&) {
      // of whole numbers, whose own check says more
    }
    option_->check(CLI::Validator(
        [good, expected](std::string& text) {
          const std::optional<double> value = finite_number(text);
          return value && good(*value) ? std::string() : "expected " + expected + ", got '" + text + "'";
        },
        description));
  };
  switch (check.kind_) {
    case Check::Kind::one_of: {
      std::string list;
      for (const std::string& word : check.values_) list += (list.empty() ? "" : ",") + word;
      option_->check(CLI::Validator(
          [words = check.values_](std::string& text) {
            for (const std::string& word : words)
              if (word == text) return std::string();
            const std::string meant = closest(text, words);
            return "expected " + alternatives(words) + ", got '" + text + "'" +
                   (meant.empty() ? "" : "; did you mean " + meant + "?");
          },
          "{" + list + "}"));
      break;
    }
    case Check::Kind::range: {
      const double least = check.least_, most = check.most_;
      add([least, most](double value) { return value >= least && value <= most; },
          shortest(least) + " to " + shortest(most), "[" + shortest(least) + " to " + shortest(most) + "]");
      break;
    }
    case Check::Kind::not_negative:
      add([](double value) { return value >= 0; }, "a number from 0 up", "NUMBER >= 0");
      break;
    case Check::Kind::above_zero: {
      const double least = check.least_, most = check.most_;
      add([most](double value) { return value > 0 && value <= most; },
          "a number above 0, at most " + shortest(most), "NUMBER > 0");
      if (least > 0) add([least](double value) { return value >= least; }, "at least " + shortest(least), "");
      break;
    }
  }
  return *this;
}

}  // namespace egocal::cli
