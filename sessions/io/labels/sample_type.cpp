// SPDX-License-Identifier: Apache-2.0
#include "sessions/io/labels/sample_type.h"

namespace boresight::sessions {

const char* sampleTypeName(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
      return "8-bit unsigned integers";
    case SampleType::kInt8:
      return "8-bit signed integers";
    case SampleType::kUint16:
      return "16-bit unsigned integers";
    case SampleType::kInt16:
      return "16-bit signed integers";
    case SampleType::kUint32:
      return "32-bit unsigned integers";
    case SampleType::kInt32:
      return "32-bit signed integers";
    case SampleType::kFloat:
      return "32-bit floating-point numbers";
    case SampleType::kDouble:
      return "64-bit floating-point numbers";
  }
  return "unknown";
}

int bitsOf(SampleType type) {
  switch (type) {
    case SampleType::kUint8:
    case SampleType::kInt8:
      return 8;
    case SampleType::kUint16:
    case SampleType::kInt16:
      return 16;
    case SampleType::kUint32:
    case SampleType::kInt32:
    case SampleType::kFloat:
      return 32;
    case SampleType::kDouble:
      return 64;
  }
  return 0;
}

}  // namespace boresight::sessions
