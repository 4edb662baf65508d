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
#include "sessions/io/files/file_bytes.h"

namespace boresight::sessions {

/// The unsigned integer of a number's size.
template <class T>
using BitsOf = std::conditional_t<
    sizeof(T) == 8, std::uint64_t,
    std::conditional_t<sizeof(T) == 4, std::uint32_t,
                       std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint8_t>>>;

/// Big-endian bytes of numbers, texts and lists. ArchiveReader has the same members, so that one
/// description of a record's fields both writes and reads it.
class ArchiveWriter {
 public:
  template <class T>
  requires std::is_arithmetic_v<T>
  void number(const T& value) {
    const std::uint64_t bits = std::bit_cast<BitsOf<T>>(value);
    for (std::size_t i = sizeof(T); i-- > 0;)
      bytes_.push_back(static_cast<std::uint8_t>(bits >> (8 * i)));
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
  requires std::is_arithmetic_v<T>
  void number(T& value) {
    require(sizeof(T) <= bytes_.size() - place_, "truncated");
    const auto bits =
        static_cast<BitsOf<T>>(readUnsigned(bytes_, place_, static_cast<int>(sizeof(T)), true));
    place_ += sizeof(T);
    if constexpr (std::is_same_v<T, bool>)
      value = bits != 0;
    else
      value = std::bit_cast<T>(bits);
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
  std::filesystem::path file_;
  std::span<const std::uint8_t> bytes_;
  std::size_t place_ = 0;
};

}  // namespace boresight::sessions
