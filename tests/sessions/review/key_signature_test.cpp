// SPDX-License-Identifier: Apache-2.0
#include "sessions/review/key_signature.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "sessions/io/files/errors.h"
#include "tests/support/temporary_folder.h"

namespace boresight::test {
namespace {

namespace fs = std::filesystem;
using sessions::isSignedBy;

/// A file with two keys for it; each signature is in a file of its own.
class KeySignature : public testing::Test {
 protected:
  void SetUp() override {
    if (std::system("command -v ssh-keygen >/dev/null") != 0) GTEST_SKIP() << "no ssh-keygen";
    newKey("ada");
    newKey("bob");
    signers_ = folder_.write("signers",
                             "Ada " + folder_.read("ada.pub") + "Bob " + folder_.read("bob.pub"));
  }
  void newKey(const std::string& name) const {
    call("ssh-keygen -q -t ed25519 -N '' -C x -f " + (folder_ / name).string());
  }
  /// Signs the file; the signature gets this name.
  void sign(const std::string& key, const std::string& signature) const {
    call("ssh-keygen -q -Y sign -n boresight -f " + (folder_ / key).string() + " " +
         file_.string() + " 2>/dev/null");
    if (signature != "a.json.sig") fs::rename(file_.string() + ".sig", folder_ / signature);
  }
  static void call(const std::string& command) {
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
  }
  bool isSigned(const std::string& by) const { return isSignedBy(by, file_, signers_); }

  TemporaryFolder folder_;
  fs::path file_ = folder_.write("a.json", std::string_view("{}"));
  fs::path signers_;
};

TEST_F(KeySignature, EachSignatureFileNextToTheFile_IsTried) {
  EXPECT_FALSE(isSigned("Ada"));
  sign("ada", "a.json.ada.sig");
  EXPECT_TRUE(isSigned("Ada"));
  EXPECT_FALSE(isSigned("Bob")) << "a key of another person";
  EXPECT_FALSE(isSigned("Eve")) << "a name that is not listed";
  sign("bob", "a.json.sig");
  EXPECT_TRUE(isSigned("Ada"));
  EXPECT_TRUE(isSigned("Bob"));
  folder_.write("a.json", std::string_view("{ }"));
  EXPECT_FALSE(isSigned("Ada")) << "the file has changed";
}

TEST_F(KeySignature, SignatureOfAnotherName_IsNotTried) {
  for (const char* name : {"b.json.sig", "a.json.signature", "a.jsonx.sig", "xa.json.sig"}) {
    sign("ada", name);
    EXPECT_FALSE(isSigned("Ada")) << name;
  }
}

TEST_F(KeySignature, FileWithoutAFolder_HasItsSignaturesInTheWorkingOne) {
  sign("ada", "a.json.sig");
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path());
  EXPECT_TRUE(isSignedBy("Ada", "a.json", "signers"));
  fs::current_path(before);
}

TEST_F(KeySignature, MissingSigners_AreRefused) {
  EXPECT_THROW((void)isSignedBy("Ada", file_, folder_ / "none"), sessions::InputError);
  EXPECT_THROW((void)isSignedBy("Ada", file_, folder_.path()), sessions::InputError);
}

}  // namespace
}  // namespace boresight::test
