// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <utility>

namespace boresight::sessions {

/// An immutable value that copies share: copying a session with a thousand cases copies pointers.
/// Compares by value; the same pointer is the same value.
template <class T>
class SharedValue {
 public:
  SharedValue() : SharedValue(T()) {}
  SharedValue(T value) : value_(std::make_shared<const T>(std::move(value))) {}  // NOLINT: a value

  const T& operator*() const { return *value_; }
  const T* operator->() const { return value_.get(); }
  /// Whether both are copies of one and the same value.
  bool sharesWith(const SharedValue& other) const { return value_ == other.value_; }

  bool operator==(const SharedValue& other) const {
    return sharesWith(other) || *value_ == *other.value_;
  }

 private:
  std::shared_ptr<const T> value_;
};

}  // namespace boresight::sessions
