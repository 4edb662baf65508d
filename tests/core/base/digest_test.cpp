// SPDX-License-Identifier: Apache-2.0
#include "core/base/digest.h"

#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/random.h"
#include "tests/support/not_finite.h"

namespace boresight {
namespace {

std::span<const std::uint8_t> bytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

std::string sha256(std::string_view text) {
  Sha256 sha;
  sha.update(bytesOf(text));
  return hexText(sha.digest()).data();
}

TEST(Sha256, GivesThePublishedDigests) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256("abcdefghbcdefghicdefghijdefghijkefghijklfghijklmghijklmn"
                   "hijklmnoijklmnopjklmnopqklmnopqrlmnopqrsmnopqrstnopqrstu"),
            "cf5b16a778af8380036ce59e7b0492370b249b11e8f07a51afac45037afee9d1");
  EXPECT_EQ(sha256(std::string(1000000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, DigestDoesNotDependOnTheSplitOfTheInput) {
  Random random(1);
  std::string text;
  for (int i = 0; i < 1000; ++i) text.push_back(static_cast<char>(random.below(256)));
  for (std::size_t length = 0; length < 260; ++length) {
    const std::string_view message = std::string_view(text).substr(0, length);
    Sha256 pieces;
    std::size_t fed = 0;
    while (fed < length) {
      const std::size_t piece = std::min<std::size_t>(random.below(100), length - fed);
      pieces.update(bytesOf(message.substr(fed, piece)));
      fed += piece;
    }
    EXPECT_EQ(std::string(hexText(pieces.digest()).data()), sha256(message)) << length;
  }
}

TEST(Sha256, GivesTheSameWithTheProcessorsOwnInstructions) {
  const Sha256Kernel instructions = sha256Instructions();
  if (instructions == nullptr) GTEST_SKIP() << "this processor has no SHA instructions";
  Random random(2);
  std::vector<std::uint8_t> blocks(64 * 9);
  Sha256State plain{};
  Sha256State fast{};
  for (int round = 0; round < 200; ++round) {
    for (std::uint8_t& byte : blocks) byte = static_cast<std::uint8_t>(random.below(256));
    for (std::uint32_t& word : plain) word = random.below(0xffffffffu);
    fast = plain;
    const std::size_t count = static_cast<std::size_t>(round) % 10;
    sha256Plain(plain, blocks.data(), count);
    instructions(fast, blocks.data(), count);
    ASSERT_EQ(plain, fast) << count << " blocks";
  }
}

TEST(Sha256, TakesValuesAsTheirBytes) {
  Random random(3);
  for (const Sha256Kernel kernel : {sha256Plain, fastestSha256()}) {
    Sha256 values(kernel);
    std::vector<std::uint8_t> bytes;
    for (int i = 0; i < 3000; ++i) {
      const std::uint64_t value = random.below(0xffffffffu) * std::uint64_t{0x9e3779b97f4a7c15};
      const std::size_t size = std::size_t{1} << random.below(4);
      if (size == 1) values.updateBigEndian(static_cast<std::uint8_t>(value));
      if (size == 2) values.updateBigEndian(static_cast<std::uint16_t>(value));
      if (size == 4) values.updateBigEndian(static_cast<std::uint32_t>(value));
      if (size == 8) values.updateBigEndian(value);
      for (std::size_t k = size; k-- > 0;)
        bytes.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
    }
    Sha256 whole(sha256Plain);
    whole.update(bytes);
    EXPECT_EQ(values.digest(), whole.digest());
  }
}

TEST(Sha256, UpdateAfterDigest_Continues) {
  Sha256 sha;
  sha.update(bytesOf("a"));
  const auto early = sha.digest();
  EXPECT_EQ(early, sha.digest());
  sha.update(bytesOf("bc"));
  EXPECT_EQ(std::string(hexText(sha.digest()).data()), sha256("abc"));
}

/// What a writer fed by `write` hashed must be exactly these bytes.
template <class Write>
void expectBytes(Write write, const std::vector<std::uint8_t>& bytes) {
  DigestWriter writer;
  write(writer);
  Sha256 sha;
  sha.update(bytes);
  EXPECT_EQ(writer.digest(), sha.digest());
}

TEST(DigestWriter, WritesBigEndian) {
  expectBytes([](DigestWriter& w) { w.u8(0xfe); }, {0xfe});
  expectBytes([](DigestWriter& w) { w.u32(0x01020304); }, {1, 2, 3, 4});
  expectBytes([](DigestWriter& w) { w.i32(-2); }, {0xff, 0xff, 0xff, 0xfe});
  expectBytes([](DigestWriter& w) { w.u64(0x0102030405060708); }, {1, 2, 3, 4, 5, 6, 7, 8});
  const std::vector<std::uint8_t> raw = {9, 8, 7};
  expectBytes([&raw](DigestWriter& w) { w.bytes(raw); }, raw);
  expectBytes([](DigestWriter& w) { w.f32(1.0f); }, {0x3f, 0x80, 0, 0});
  expectBytes([](DigestWriter& w) { w.f64(-2.0); }, {0xc0, 0, 0, 0, 0, 0, 0, 0});
  expectBytes([](DigestWriter& w) { w.f64(1.0 / 3.0); },
              {0x3f, 0xd5, 0x55, 0x55, 0x55, 0x55, 0x55, 0x55});
}

TEST(DigestWriter, CountsBothZerosAsOneAndAllNansAsOne) {
  expectBytes([](DigestWriter& w) { w.f32(-0.0f); }, {0, 0, 0, 0});
  expectBytes([](DigestWriter& w) { w.f64(-0.0); }, {0, 0, 0, 0, 0, 0, 0, 0});
  for (const double nan : {test::kNan, -test::kNan}) {
    expectBytes([nan](DigestWriter& w) { w.f64(nan); }, {0x7f, 0xf8, 0, 0, 0, 0, 0, 0});
    expectBytes([nan](DigestWriter& w) { w.f32(static_cast<float>(nan)); }, {0x7f, 0xc0, 0, 0});
  }
}

TEST(DigestWriter, TagsCarryTheirLength) {
  expectBytes([](DigestWriter& w) { w.tag("edges"); }, {0, 0, 0, 5, 'e', 'd', 'g', 'e', 's'});
  // "ab", "c" differs from "a", "bc".
  const auto two_tags = [](DigestWriter& w) {
    w.tag("ab");
    w.tag("c");
  };
  expectBytes(two_tags, {0, 0, 0, 2, 'a', 'b', 0, 0, 0, 1, 'c'});
}

TEST(HexText, IsLowerCaseAndTerminated) {
  std::array<std::uint8_t, 32> digest{};
  digest[0] = 0x0f;
  digest[31] = 0xab;
  const auto text = hexText(digest);
  EXPECT_EQ(std::string(text.data()), "0f" + std::string(60, '0') + "ab");
}

}  // namespace
}  // namespace boresight
