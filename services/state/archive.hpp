// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "egocal/error.hpp"

namespace egocal::services {

/// T is U or const U: one function serves for writing and reading.
template <class T, class U>
concept Is = std::same_as<std::remove_const_t<T>, U>;

template <class T>
concept Scalar = std::is_arithmetic_v<T> || std::is_enum_v<T>;

template <class T>
concept Fixed = requires {
  typename T::Scalar;
}
&&std::derived_from<T, Eigen::MatrixBase<T>>&& T::SizeAtCompileTime != Eigen::Dynamic;

template <class T>
concept Sequence = requires(T t) {
  t.emplace_back();
  t.clear();
}
&&!std::same_as<T, std::string>;

/// Writes the bits of values one after the other, in the byte order of this machine. An overload of
/// fields(archive, value) writes a struct field by field.
class Writer {
 public:
  template <class... T>
  void operator()(const T&... values) {
    (put(values), ...);
  }
  const std::vector<std::byte>& bytes() const { return bytes_; }
  void clear() { bytes_.clear(); }

  void raw(const void* data, std::size_t size) {
    const auto* begin = static_cast<const std::byte*>(data);
    bytes_.insert(bytes_.end(), begin, begin + size);
  }

 private:
  template <class T>
  void put(const T& value) {
    if constexpr (Scalar<T>) {
      raw(&value, sizeof value);
    } else if constexpr (Fixed<T>) {
      raw(value.data(), sizeof(typename T::Scalar) * static_cast<std::size_t>(T::SizeAtCompileTime));
    } else {
      fields(*this, value);
    }
  }
  void put(const std::string& text) {
    put(static_cast<std::uint64_t>(text.size()));
    raw(text.data(), text.size());
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(static_cast<std::uint8_t>(value.has_value()));
    if (value) put(*value);
  }
  template <class T, std::size_t n>
  void put(const std::array<T, n>& values) {
    for (const T& value : values) put(value);
  }
  template <Sequence T>
  void put(const T& values) {
    put(static_cast<std::uint64_t>(values.size()));
    for (const auto& value : values) put(value);
  }
  template <class K, class V>
  void put(const std::map<K, V>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    for (const auto& [key, value] : values) {
      put(key);
      put(value);
    }
  }

  template <class T>
  void put(const std::set<T>& values) {
    put(static_cast<std::uint64_t>(values.size()));
    for (const T& value : values) put(value);
  }

  std::vector<std::byte> bytes_;
};

/// Reads what a Writer wrote, in the same order. Throws Error if the bytes end too early. A count never makes
/// it allocate more than a small multiple of the bytes that are there.
class Reader {
 public:
  explicit Reader(std::span<const std::byte> bytes) : rest_(bytes) {}
  template <class... T>
  void operator()(T&... values) {
    (get(values), ...);
  }
  bool done() const { return rest_.empty(); }

  void raw(void* data, std::size_t size) {
    if (size > rest_.size()) throw Error("ends too early");
    std::memcpy(data, rest_.data(), size);
    rest_ = rest_.subspan(size);
  }
  std::span<const std::byte> view(std::size_t size) {
    if (size > rest_.size()) throw Error("ends too early");
    const auto bytes = rest_.first(size);
    rest_ = rest_.subspan(size);
    return bytes;
  }

 private:
  std::size_t count() {
    std::uint64_t n = 0;
    get(n);
    if (n > rest_.size()) throw Error("holds a count that is too large");
    return static_cast<std::size_t>(n);
  }
  template <class T>
  void get(T& value) {
    if constexpr (std::same_as<T, bool>) {
      std::uint8_t byte = 0;
      raw(&byte, 1);
      value = byte != 0;
    } else if constexpr (Scalar<T>) {
      raw(&value, sizeof value);
    } else if constexpr (Fixed<T>) {
      raw(value.data(), sizeof(typename T::Scalar) * static_cast<std::size_t>(T::SizeAtCompileTime));
    } else {
      fields(*this, value);
    }
  }
  void get(std::string& text) {
    text.resize(count());
    raw(text.data(), text.size());
  }
  template <class T>
  void get(std::optional<T>& value) {
    bool there = false;
    get(there);
    value.reset();
    if (there) get(value.emplace());
  }
  template <class T, std::size_t n>
  void get(std::array<T, n>& values) {
    for (T& value : values) get(value);
  }
  template <Sequence T>
  void get(T& values) {
    values.clear();
    for (std::size_t n = count(); n > 0; --n) get(values.emplace_back());
  }
  template <class K, class V>
  void get(std::map<K, V>& values) {
    values.clear();
    for (std::size_t n = count(); n > 0; --n) {
      K key{};
      get(key);
      get(values[key]);
    }
  }

  template <class T>
  void get(std::set<T>& values) {
    values.clear();
    for (std::size_t n = count(); n > 0; --n) {
      T value{};
      get(value);
      values.insert(std::move(value));
    }
  }

  std::span<const std::byte> rest_;
};

/// Detects every change of a single byte, and other changes except for one in 2^64 (FNV-1a).
inline std::uint64_t checksum(std::span<const std::byte> bytes) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const std::byte byte : bytes) hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3ULL;
  return hash;
}

}  // namespace egocal::services
