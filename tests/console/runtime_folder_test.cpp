// Runtime folders: only private ones are used, and sockets of dead programs are removed.
#include "net/console/runtime_folder.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>

#include "base/system/net/local_socket.h"
#include "console/private_folder.h"

namespace limber::console {
namespace {

namespace fs = std::filesystem;

bool lists(const std::vector<std::string>& all, const std::string& one) { return std::ranges::count(all, one) == 1; }

unsigned mode_of(const std::string& path) {
  struct stat about {};
  return lstat(path.c_str(), &about) == 0 ? about.st_mode & 07777u : 0;
}

TEST(RuntimeFolder, TheConfiguredFolderComesFirst) {
  const PrivateFolder named;
  const PrivateFolder temp;
  const Environment runtime("XDG_RUNTIME_DIR", named.path().c_str());
  const Environment tmpdir("TMPDIR", temp.path().c_str());
  EXPECT_EQ(runtime_folders(), std::vector<std::string>{named.path()});
  EXPECT_EQ(*make_runtime_folder(), named.path());
  EXPECT_TRUE(fs::is_empty(temp.path())) << "no unneeded folder is created";
}

TEST(RuntimeFolder, AnAccessibleFolderIsNotUsed) {
  const PrivateFolder named;
  const PrivateFolder temp;
  const Environment runtime("XDG_RUNTIME_DIR", named.path().c_str());
  const Environment tmpdir("TMPDIR", temp.path().c_str());
  for (const mode_t open : {0755, 0710, 0701, 0777}) {
    chmod(named.path().c_str(), open);
    EXPECT_FALSE(lists(runtime_folders(), named.path())) << open;
  }
  chmod(named.path().c_str(), 0700);
  EXPECT_TRUE(lists(runtime_folders(), named.path()));
  // a symlink to a private folder, a file, a relative path
  const std::string link = temp / "link";
  fs::create_directory_symlink(named.path(), link);
  const Environment linked("XDG_RUNTIME_DIR", link.c_str());
  EXPECT_FALSE(lists(runtime_folders(), link));
  const Environment relative("XDG_RUNTIME_DIR", "here");
  EXPECT_FALSE(lists(runtime_folders(), "here"));
}

TEST(RuntimeFolder, CreatesAPrivateTemporaryFolder) {
  const PrivateFolder temp;
  const Environment runtime("XDG_RUNTIME_DIR", "/nowhere/at/all");
  const Environment tmpdir("TMPDIR", temp.path().c_str());
  const std::string made = temp / ("limber-" + std::to_string(geteuid()));
  EXPECT_TRUE(runtime_folders().empty()) << "listing creates nothing";
  const Result<std::string> folder = make_runtime_folder();
  ASSERT_TRUE(folder.ok()) << folder.error();
  EXPECT_EQ(*folder, made);
  EXPECT_EQ(mode_of(made), 0700U);
  EXPECT_TRUE(lists(runtime_folders(), made));
  // the folder exists with public permissions
  chmod(made.c_str(), 0777);
  EXPECT_EQ(make_runtime_folder().error(),
            "the folder " + made + " can't be used: other users can access it; run chmod 700 " + made);
  fs::remove(made);
  fs::create_directory_symlink(temp.path(), made);
  EXPECT_EQ(make_runtime_folder().error(), "the folder " + made + " can't be used: it is not a folder");
}

TEST(RuntimeFolder, SocketsOfDeadProgramsAreRemoved) {
  const PrivateFolder folder;
  const std::string dead = socket_path(folder.path(), 123);
  const std::string alive = socket_path(folder.path(), 45);
  { const Result<system::Descriptor> closes = system::listen_local(dead); }
  const Result<system::Descriptor> listener = system::listen_local(alive);
  ASSERT_TRUE(listener.ok()) << listener.error();
  // unrelated files stay
  const std::string file = folder / "limber-9.sock";
  const std::string other = folder / "limber-x.sock";
  const std::string named = folder / "limber-77.sock.new";
  close(open(file.c_str(), O_CREAT | O_WRONLY, 0600));
  { const Result<system::Descriptor> closes = system::listen_local(other); }
  { const Result<system::Descriptor> closes = system::listen_local(named); }
  const std::vector<ConsoleSocket> found = console_sockets(folder.path());
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].pid, 45);
  EXPECT_EQ(found[0].path, alive);
  EXPECT_FALSE(fs::exists(dead));
  EXPECT_TRUE(fs::exists(file) && fs::exists(other) && fs::exists(named));
  EXPECT_TRUE(console_sockets("/nowhere/at/all").empty());
}

TEST(RuntimeFolder, ListenersAreSortedByPid) {
  const PrivateFolder folder;
  std::vector<system::Descriptor> listeners;
  for (const int pid : {300, 7, 12}) {
    Result<system::Descriptor> listener = system::listen_local(socket_path(folder.path(), pid));
    ASSERT_TRUE(listener.ok());
    listeners.push_back(std::move(*listener));
  }
  // a listener with a full queue counts as running
  std::vector<system::Descriptor> waiting;
  sockaddr_un at{};
  at.sun_family = AF_UNIX;
  socket_path(folder.path(), 7).copy(at.sun_path, sizeof at.sun_path - 1);
  while (waiting.size() < 100) {
    system::Descriptor connection(socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0));
    if (connect(connection.fd(), reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) break;
    waiting.push_back(std::move(connection));
  }
  EXPECT_LT(waiting.size(), 100U);
  std::vector<int> pids;
  for (const ConsoleSocket& each : console_sockets(folder.path())) pids.push_back(each.pid);
  EXPECT_EQ(pids, (std::vector<int>{7, 12, 300}));
}

TEST(RuntimeFolder, ASocketIsPrivate) {
  const PrivateFolder folder;
  const std::string path = socket_path(folder.path(), 5);
  const Result<system::Descriptor> listener = system::listen_local(path);
  ASSERT_TRUE(listener.ok()) << listener.error();
  EXPECT_EQ(mode_of(path), 0600U);
  EXPECT_FALSE(fs::exists(path + ".new"));
  const Result<system::Descriptor> connection = connect_console(path);
  ASSERT_TRUE(connection.ok()) << connection.error();
  EXPECT_EQ(system::peer_user(*connection), static_cast<long>(geteuid()));
  EXPECT_EQ(system::peer_user(system::Descriptor()), -1);
  // reuse of the path, as by a new program with the pid of a dead one
  EXPECT_TRUE(system::listen_local(path).ok());
}

TEST(RuntimeFolder, ErrorsHaveAReason) {
  const PrivateFolder folder;
  EXPECT_EQ(connect_console(folder / "none.sock").error(), folder / "none.sock: No such file or directory");
  EXPECT_EQ(system::listen_local(folder / "no/where.sock").error(),
            folder / "no/where.sock: No such file or directory");
  const std::string longest = folder / (std::string(100, 'x') + ".sock");
  EXPECT_EQ(connect_console(longest).error(), longest + " is too long for a socket's path (107 bytes at most)");
}

}  // namespace
}  // namespace limber::console
