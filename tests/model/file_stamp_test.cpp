// A file's stamp: what changed is another file, whatever its times say.
#include "model/file_stamp.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace limber {
namespace {

namespace fs = std::filesystem;

struct FileStampTest : testing::Test {
  void SetUp() override { write("one"); }
  void TearDown() override { fs::remove(path); }
  void write(const std::string& text) const { std::ofstream(path, std::ios::binary) << text; }

  const std::string path = (fs::temp_directory_path() / ("limber_stamp_" + std::to_string(::getpid()))).string();
};

TEST_F(FileStampTest, HoldsWhileTheFileStays) {
  FileStamp stamp(path);
  EXPECT_TRUE(stamp.holds(path));
  // of another age, with the same in it
  fs::last_write_time(path, fs::last_write_time(path) - std::chrono::hours(1));
  EXPECT_TRUE(stamp.holds(path));
  EXPECT_TRUE(stamp == FileStamp(path));
}

TEST_F(FileStampTest, EndsWithAnotherContent) {
  FileStamp stamp(path);
  write("two");
  EXPECT_FALSE(stamp.holds(path));
  stamp = FileStamp(path);
  write("longer");
  EXPECT_FALSE(stamp.holds(path));
  EXPECT_FALSE(stamp == FileStamp(path));
}

TEST_F(FileStampTest, AFileThatIsNotThereIsOneToo) {
  fs::remove(path);
  FileStamp none(path);
  EXPECT_TRUE(none.holds(path));
  write("one");
  EXPECT_FALSE(none.holds(path));
}

// A clock of a file system that ticks too slowly gives two saves one time. Here the second change goes through memory
// that is the file's: Linux notes a time at the first write to a page, and none for those that follow.
TEST_F(FileStampTest, AYoungFileIsReadWhateverItsTimesSay) {
  const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
  ASSERT_GE(file, 0);
  auto* const text = static_cast<char*>(mmap(nullptr, 3, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0));
  close(file);
  ASSERT_NE(static_cast<void*>(text), MAP_FAILED);
  text[0] = 'O';
  FileStamp stamp(path);
  EXPECT_TRUE(stamp.holds(path));
  text[1] = 'N';
  EXPECT_FALSE(stamp.holds(path));
  munmap(text, 3);
}

}  // namespace
}  // namespace limber
