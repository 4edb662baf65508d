// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace boresight::test {

/// A folder of one test's own, removed with it.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "boresight-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  /// Writes a file and returns its path.
  std::filesystem::path write(const std::string& name, std::string_view text) const {
    std::filesystem::create_directories((path_ / name).parent_path());
    std::ofstream(path_ / name, std::ios::binary).write(text.data(), std::ssize(text));
    return path_ / name;
  }
  std::filesystem::path write(const std::string& name, std::span<const std::uint8_t> bytes) const {
    return write(name, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  }

  std::string read(const std::string& name) const {
    std::ifstream stream(path_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  }

  std::size_t fileCount() const {
    const auto all = std::filesystem::recursive_directory_iterator(path_);
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }

  /// What `call` throws, without this folder's path; "(nothing)" when it returns.
  template <class Call>
  std::string message(Call&& call) const {
    using Called = std::remove_reference_t<Call>;
    // So that only a line is compiled for each caller.
    return messageOf([](const void* called) { (*static_cast<const Called*>(called))(); }, &call);
  }

 private:
  std::string messageOf(void (*run)(const void*), const void* called) const {
    try {
      run(called);
    } catch (const std::exception& error) {
      std::string text = error.what();
      const std::string prefix = path_.string() + "/";
      for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix))
        text.erase(at, prefix.size());
      return text;
    }
    return "(nothing)";
  }

  std::filesystem::path path_;
};

}  // namespace boresight::test
