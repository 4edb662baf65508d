// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "sessions/io/files/errors.h"

namespace boresight::sessions {

/// Big-endian bytes of numbers, texts and lists. ArchiveReader has the same members, so that one
/// description of a record's fields both writes and reads it.
class ArchiveWriter {
 public:
  template <class T>
  void number(const T& value) {
    if constexpr (std::is_same_v<T, double>) {
      put(std::bit_cast<std::uint64_t>(value));
    } else if constexpr (std::is_same_v<T, float>) {
      put(std::bit_cast<std::uint32_t>(value));
    } else if constexpr (std::is_same_v<T, bool>) {
      put(static_cast<std::uint8_t>(value));
    } else {
      put(static_cast<std::make_unsigned_t<T>>(value));
    }
  }
  /// An enumeration whose last value is `last`.
  template <class E>
  void choice(const E& value, E /*last*/) {
    number(static_cast<std::uint8_t>(value));
  }
  void text(const std::string& value) {
    number(static_cast<std::uint32_t>(value.size()));
    bytes_.insert(bytes_.end(), value.begin(), value.end());
  }
  template <class T, class Field>
  void list(const std::vector<T>& values, Field&& field) {
    number(static_cast<std::uint32_t>(values.size()));
    for (const T& value : values) field(value);
  }
  void require(bool /*holds*/, const char* /*reason*/) const {}

  std::vector<std::uint8_t>& bytes() { return bytes_; }

 private:
  template <class U>
  void put(U value) {
    for (std::size_t i = sizeof(U); i-- > 0;)
      bytes_.push_back(static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i)));
  }

  std::vector<std::uint8_t> bytes_;
};

/// Reads output of ArchiveWriter, and blocks of onboard records; InputError where bytes are missing
/// or impossible. A list grows with the bytes available, so that a wrong count cannot exhaust the
/// memory.
class ArchiveReader {
 public:
  ArchiveReader(std::filesystem::path file, std::span<const std::uint8_t> bytes)
      : file_(std::move(file)), bytes_(bytes) {}

  template <class T>
  void number(T& value) {
    if constexpr (std::is_same_v<T, double>) {
      value = std::bit_cast<double>(take<std::uint64_t>());
    } else if constexpr (std::is_same_v<T, float>) {
      value = std::bit_cast<float>(take<std::uint32_t>());
    } else if constexpr (std::is_same_v<T, bool>) {
      value = take<std::uint8_t>() != 0;
    } else {
      value = static_cast<T>(take<std::make_unsigned_t<T>>());
    }
  }
  template <class E>
  void choice(E& value, E last) {
    std::uint8_t index = 0;
    number(index);
    require(index <= static_cast<std::uint8_t>(last), "a choice that does not exist");
    value = static_cast<E>(index);
  }
  void text(std::string& value) {
    std::uint32_t size = 0;
    number(size);
    require(size <= bytes_.size() - place_, "truncated");
    value.assign(reinterpret_cast<const char*>(bytes_.data()) + place_, size);
    place_ += size;
  }
  template <class T, class Field>
  void list(std::vector<T>& values, Field&& field) {
    std::uint32_t count = 0;
    number(count);
    values.clear();
    for (std::uint32_t i = 0; i < count; ++i) field(values.emplace_back());
  }
  /// InputError at the place that was read last unless `holds`.
  void require(bool holds, const char* reason) const {
    if (!holds) throw InputError(file_, "byte " + std::to_string(place_), reason);
  }
  bool atEnd() const { return place_ == bytes_.size(); }

 private:
  template <class U>
  U take() {
    require(sizeof(U) <= bytes_.size() - place_, "truncated");
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < sizeof(U); ++i) value = value << 8 | bytes_[place_ + i];
    place_ += sizeof(U);
    return static_cast<U>(value);
  }

  std::filesystem::path file_;
  std::span<const std::uint8_t> bytes_;
  std::size_t place_ = 0;
};

}  // namespace boresight::sessions
