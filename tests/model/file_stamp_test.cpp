// FileStamp: detects changes of content, independent of the file's times.
#include "model/file_stamp.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace limber::model {
namespace {

namespace fs = std::filesystem;

struct FileStampTest : testing::Test {
  void SetUp() override { write("one"); }
  void TearDown() override { fs::remove(path); }
  void write(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }

  const std::string path = (fs::temp_directory_path() / ("limber_stamp_" + std::to_string(::getpid()))).string();
};

TEST_F(FileStampTest, IsCurrentWhileTheFileIsUnchanged) {
  FileStamp stamp(path);
  EXPECT_TRUE(stamp.is_current(path));
  // another time, the same content
  fs::last_write_time(path, fs::last_write_time(path) - std::chrono::hours(1));
  EXPECT_TRUE(stamp.is_current(path));
  EXPECT_TRUE(stamp == FileStamp(path));
}

TEST_F(FileStampTest, DetectsChangedContent) {
  FileStamp stamp(path);
  write("two");
  EXPECT_FALSE(stamp.is_current(path));
  stamp = FileStamp(path);
  write("longer");
  EXPECT_FALSE(stamp.is_current(path));
  EXPECT_FALSE(stamp == FileStamp(path));
}

TEST_F(FileStampTest, HandlesAMissingFile) {
  fs::remove(path);
  FileStamp none(path);
  EXPECT_TRUE(none.is_current(path));
  write("one");
  EXPECT_FALSE(none.is_current(path));
}

// Two saves within one tick of the file system's clock get the same time. Simulated with mapped memory: Linux updates
// the time at the first write to a page, but not at later ones.
TEST_F(FileStampTest, HashesARecentFileEvenIfItsTimesAreUnchanged) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(file, 0);
  auto* const text = static_cast<char*>(mmap(nullptr, 3, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
  close(file);
  ASSERT_NE(static_cast<void*>(text), MAP_FAILED);
  text[0] = 'O';
  FileStamp stamp(path);
  EXPECT_TRUE(stamp.is_current(path));
  text[1] = 'N';
  EXPECT_FALSE(stamp.is_current(path));
  munmap(text, 3);
}

}  // namespace
}  // namespace limber::model
