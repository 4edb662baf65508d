// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

namespace boresight {

/// Writes big-endian values to the front of a block. Bytes that do not fit are counted, so that a
/// writer without a block measures the size needed.
class ByteWriter {
 public:
  ByteWriter() = default;  ///< counts only
  /// `block` must outlive the writer.
  explicit ByteWriter(std::span<std::uint8_t> block) : block_(block) {}

  /// Appends a value, the most significant byte first.
  ///@{
  void u8(std::uint8_t value) {
    if (written_ < block_.size()) block_[written_] = value;
    ++written_;
  }
  void u16(std::uint16_t value) { put(value, 2); }
  void u32(std::uint32_t value) { put(value, 4); }
  void i32(std::int32_t value) { u32(static_cast<std::uint32_t>(value)); }
  void u64(std::uint64_t value) { put(value, 8); }
  void f32(float value) { u32(std::bit_cast<std::uint32_t>(value)); }
  void f64(double value) { u64(std::bit_cast<std::uint64_t>(value)); }
  void bytes(std::span<const std::uint8_t> values) {
    for (const std::uint8_t value : values) u8(value);
  }
  ///@}

  std::size_t written() const { return written_; }  ///< including bytes that did not fit

 private:
  void put(std::uint64_t value, int count) {
    for (int i = count - 1; i >= 0; --i) u8(static_cast<std::uint8_t>(value >> (8 * i)));
  }

  std::span<std::uint8_t> block_;
  std::size_t written_ = 0;
};

/// Reads big-endian values from the front of a span. Never reads beyond its end: from the first
/// value that does not fit on, all values are 0 and failed() is true.
class ByteReader {
 public:
  /// `bytes` must outlive the reader.
  explicit ByteReader(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  /// Takes the next value.
  ///@{
  std::uint8_t u8() { return static_cast<std::uint8_t>(get(1)); }
  std::uint16_t u16() { return static_cast<std::uint16_t>(get(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(get(4)); }
  std::int32_t i32() { return static_cast<std::int32_t>(u32()); }
  std::uint64_t u64() { return get(8); }
  float f32() { return std::bit_cast<float>(u32()); }
  double f64() { return std::bit_cast<double>(u64()); }
  ///@}
  /// The next `count` bytes; empty when there are fewer.
  std::span<const std::uint8_t> take(std::size_t count) {
    if (!fits(count, 1)) failed_ = true;
    if (failed_) return {};
    const std::span<const std::uint8_t> taken = rest_.first(count);
    rest_ = rest_.subspan(count);
    return taken;
  }

  /// Whether `count` values of `bytes_each` are left, without computing their product.
  bool fits(std::uint64_t count, std::size_t bytes_each) const {
    return !failed_ && count <= rest_.size() / bytes_each;
  }
  /// Number of bytes left.
  std::size_t left() const { return rest_.size(); }
  /// Whether a value did not fit.
  bool failed() const { return failed_; }

 private:
  std::uint64_t get(std::size_t count) {
    std::uint64_t value = 0;
    for (const std::uint8_t byte : take(count)) value = (value << 8) | byte;
    return value;
  }

  std::span<const std::uint8_t> rest_;
  bool failed_ = false;
};

}  // namespace boresight
