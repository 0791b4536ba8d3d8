// OutFile: a file that is there whole or not at all: written beside its name, renamed at the end.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "base/result.h"

namespace limber {

/// What a file is called until it is whole: of this program, so that two don't share one.
std::string beside_name(const std::string& path);

class OutFile {
 public:
  /// Nothing is on the disk before open().
  explicit OutFile(const std::string& path) : OutFile(path, beside_name(path)) {}
  /// `beside`: what it is called until it is whole.
  OutFile(std::string path, std::string beside);
  /// Without finish() nothing stays.
  ~OutFile();
  OutFile(const OutFile&) = delete;
  OutFile& operator=(const OutFile&) = delete;

  /// Begins it; the error says why it can't be written there.
  Result<void> open();
  /// Adds to its end. Between two calls no descriptor is held, so thousands may be written side by side.
  Result<void> put(std::string_view bytes);
  /// What was put at `at` becomes `bytes`, as long as they are.
  Result<void> patch(std::uint64_t at, std::string_view bytes);
  /// Everything that was put stands in the file `beside()`.
  Result<void> flush();
  /// On the disk, under its name.
  Result<void> finish();

  /// Bytes put so far.
  std::uint64_t size() const { return size_; }
  const std::string& path() const { return path_; }
  /// Its name until finish().
  const std::string& beside() const { return beside_; }

 private:
  Error failed() const;

  std::string path_;
  std::string beside_;
  std::string waiting_;
  std::uint64_t size_ = 0;
  bool open_ = false;
};

}  // namespace limber
