// SPDX-License-Identifier: Apache-2.0
#include "app/documents/manual_folder.h"

#include <gtest/gtest.h>

namespace boresight::documents {
namespace {

std::string upper(const std::string& target) { return target == "gone.md" ? "" : "<" + target; }

TEST(ManualLinks, LeadElsewhereOrLeaveTheirText) {
  EXPECT_EQ(withLinks("a [b](c.md), [d](e.md#f)\n", upper), "a [b](<c.md), [d](<e.md#f)\n");
  EXPECT_EQ(withLinks("a [b `c`](gone.md) d", upper), "a b `c` d");
  EXPECT_EQ(withLinks("![p](p.png) [x](gone.md)[y](z.md)\n", upper), "![p](<p.png) x[y](<z.md)\n");
  EXPECT_EQ(withLinks("![p](gone.md)\n", upper), "p\n");
}

TEST(ManualLinks, AreWholeWithBracketsAround) {
  EXPECT_EQ(withLinks("[[a [b]](c.md)] (d)", upper), "[[a [b]](<c.md)] (d)");
  EXPECT_EQ(withLinks("m[i](n", upper), "m[i](n");
  EXPECT_EQ(withLinks("i](n)", upper), "i](n)");
  EXPECT_EQ(withLinks("", upper), "");
}

TEST(ManualLinks, OfCodeAreNone) {
  EXPECT_EQ(withLinks("```\n[a](b)\n```\n[a](b)\n", upper), "```\n[a](b)\n```\n[a](<b)\n");
}

}  // namespace
}  // namespace boresight::documents
