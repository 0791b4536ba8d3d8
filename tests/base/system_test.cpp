// The operating system layer, in the Linux build and in the portable build.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <thread>

#include "base/system/child_process.h"
#include "base/system/clock.h"
#include "base/system/executable_path.h"
#include "base/system/file.h"
#include "base/system/folder_events.h"
#include "base/system/net/local_socket.h"
#include "base/system/net/udp_socket.h"
#include "base/system/process.h"
#include "base/system/signals.h"
#include "base/system/thread.h"
#include "base/system/virtual_memory.h"
#include "base/system/wait.h"
#include "base/system/wake.h"

namespace limber::system {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kTimeout(20);  // only a failing test waits this long

struct Folder {
  Folder() : path(fs::temp_directory_path() / ("limber_system_" + std::to_string(process_id()))) {
    fs::create_directories(path);
  }
  ~Folder() { fs::remove_all(path); }
  std::string file(const std::string& name) const { return (path / name).string(); }
  fs::path path;
};

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

bool readable(int fd, std::chrono::nanoseconds limit = {}) {
  PollEntry waiting{.fd = fd};
  return wait_ready({&waiting, 1}, limit);
}

TEST(File, ReadsRegularFilesOfALimitedSizeOnly) {
  const Folder folder;
  std::ofstream(folder.file("text"), std::ios::binary) << std::string("12\0\n45", 6);
  const Result<std::string> whole = read_file(folder.file("text"), 6);
  ASSERT_TRUE(whole.ok()) << whole.error();
  EXPECT_EQ(*whole, std::string("12\0\n45", 6));
  EXPECT_EQ(read_file(folder.file("text"), 5).error(), "it has 6 bytes; at most 5 are read");
  const char* const none = "it is a folder or a device, not a file";
  EXPECT_EQ(read_file(folder.path.string(), 5).error(), none);
  EXPECT_EQ(read_file("/dev/zero", 5).error(), none);
  ASSERT_EQ(mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_EQ(read_file(folder.file("pipe"), 5).error(), none) << "a pipe without a writer";
  EXPECT_EQ(read_file(folder.file("missing"), 5).error(), "No such file or directory");
}

TEST(Wake, IsReadableFromNotifyToClear) {
  Wake wake;
  EXPECT_FALSE(readable(wake.fd()));
  for (int i = 0; i < 100000; i++) wake.notify();  // more than a pipe holds
  EXPECT_TRUE(readable(wake.fd()));
  wake.clear();
  EXPECT_FALSE(readable(wake.fd()));
  std::thread([&] { wake.notify(); }).join();
  EXPECT_TRUE(readable(wake.fd()));
}

TEST(Wake, LosesNoNotification) {
  Wake wake;
  std::atomic<int> sent{0};
  std::thread other([&] {
    for (int i = 0; i < 20000; i++) {
      sent++;
      wake.notify();
    }
  });
  int seen = 0;
  while (seen < 20000 && readable(wake.fd(), kTimeout)) {
    wake.clear();
    seen = sent.load();
  }
  other.join();
  EXPECT_EQ(seen, 20000);
}

TEST(Wait, ReportsReadyDescriptorsOnly) {
  Wake first, second;
  second.notify();
  std::array<PollEntry, 3> list{{{.fd = first.fd()}, {.fd = second.fd()}, {.fd = -1}}};
  EXPECT_TRUE(wait_ready(list, kTimeout));
  EXPECT_FALSE(list[0].ready);
  EXPECT_TRUE(list[1].ready);
  EXPECT_FALSE(list[2].ready);
  second.clear();
  EXPECT_FALSE(wait_ready(list, milliseconds(-5)));
  EXPECT_FALSE(list[1].ready);
}

TEST(Wait, WaitsForTheLimit) {
  const double begin = clock_seconds();
  Wake wake;
  std::array<PollEntry, 1> list{{{.fd = wake.fd()}}};
  EXPECT_FALSE(wait_ready(list, milliseconds(30)));
  EXPECT_GE(clock_seconds() - begin, 0.03);
}

TEST(Wait, HandlesManyDescriptors) {
  std::vector<Wake> wakes(40);
  std::vector<PollEntry> list;
  list.reserve(wakes.size());
  for (const Wake& wake : wakes) list.push_back({.fd = wake.fd()});
  wakes[37].notify();
  EXPECT_TRUE(wait_ready(list, kTimeout));
  for (std::size_t i = 0; i < list.size(); i++) EXPECT_EQ(list[i].ready, i == 37) << i;
}

TEST(Wait, BlockedSignalArrivesDuringTheWaitOnly) {
  static volatile std::sig_atomic_t received = 0;
  std::thread([] {
    block_signal(SIGUSR2);
    handle_signal(SIGUSR2, [](int) { received = 1; });
    signal_thread(this_thread(), SIGUSR2);
    EXPECT_EQ(received, 0);
    Wake wake;
    std::array<PollEntry, 1> list{{{.fd = wake.fd()}}};
    EXPECT_FALSE(wait_ready_or_signal(list, kTimeout));
    EXPECT_EQ(received, 1);
  }).join();
}

TEST(Signals, WakeThreadEndsAWait) {
  std::thread([] {
    block_signals();
    EXPECT_EQ(wait_for_signal(milliseconds(0)), Signal::none);
    const std::uint64_t waiter = this_thread();
    std::thread other([&] { wake_thread(waiter); });
    EXPECT_EQ(wait_for_signal(kTimeout), Signal::wake);
    other.join();
    EXPECT_FALSE(signal_arrived());
    signal_thread(waiter, SIGTERM);
    EXPECT_EQ(wait_for_signal(kTimeout), Signal::terminate);
  }).join();
}

TEST(Thread, ClockCountsProcessorTimeOnly) {
  const std::int64_t here = this_thread_clock();
  const std::int64_t before = cpu_nanoseconds(here);
  std::thread([&] {
    const double begin = thread_seconds();
    while (thread_seconds() - begin < 0.03) continue;
    EXPECT_GE(cpu_nanoseconds(this_thread_clock()), 30'000'000);
  }).join();
  EXPECT_LT(cpu_nanoseconds(here) - before, 20'000'000);
}

TEST(Process, ReportsIdAndExecutable) {
  EXPECT_EQ(process_id(), getpid());
  EXPECT_TRUE(is_process_running(process_id()));
  EXPECT_FALSE(is_process_running(4194304 + 7));  // above the largest possible id
  EXPECT_EQ(executable_path(), fs::read_symlink("/proc/self/exe").string());
  EXPECT_EQ(find_symbol("no_such_function_at_all"), nullptr);
  EXPECT_NE(find_symbol("strlen"), nullptr);
}

TEST(ChildProcess, ReceivesInputAndReportsItsExit) {
  const Folder folder;
  ChildProcess child;
  ASSERT_EQ(child.start({"sh", "-c", "cat > " + folder.file("copy")}), 0);
  const std::string text(300000, 'x');  // more than a pipe holds
  EXPECT_TRUE(child.write(text));
  EXPECT_TRUE(child.finish());
  EXPECT_FALSE(child.started());
  EXPECT_EQ(text_of(folder.file("copy")), text);

  ASSERT_EQ(child.start({"sh", "-c", "cat > /dev/null; exit 3"}), 0);
  EXPECT_FALSE(child.finish());
  EXPECT_EQ(child.start({"no_such_program_at_all"}), ENOENT);
  EXPECT_FALSE(child.started());
}

TEST(ChildProcess, IsKilledWithItsOwner) {
  const Folder folder;
  {
    ChildProcess child;
    ASSERT_EQ(child.start({"sh", "-c", "echo $$ > " + folder.file("pid") + "; exec cat"}), 0);
    const double late = clock_seconds() + 20;
    while (text_of(folder.file("pid")).find('\n') == std::string::npos && clock_seconds() < late) continue;
  }
  EXPECT_FALSE(is_process_running(std::stoi(text_of(folder.file("pid")))));
}

TEST(File, OpenModesCreateAppendOrReplace) {
  const Folder folder;
  const std::string file = folder.file("a");
  EXPECT_FALSE(open_file(file, OpenMode::append).is_open());
  EXPECT_EQ(errno, ENOENT);
  EXPECT_TRUE(write_all(open_file(file, OpenMode::create_new, 0640).fd(), "one"));
  EXPECT_FALSE(open_file(file, OpenMode::create_new).is_open());
  EXPECT_EQ(errno, EEXIST);
  EXPECT_TRUE(write_all(open_file(file, OpenMode::append).fd(), "two"));
  EXPECT_EQ(text_of(file), "onetwo");
  const Descriptor patch = open_file(file, OpenMode::write);
  EXPECT_TRUE(seek_to(patch.fd(), 3) && write_all(patch.fd(), "2"));
  EXPECT_EQ(text_of(file), "one2wo");
  EXPECT_TRUE(replace_file(file, "whole", 0600).ok());
  EXPECT_EQ(text_of(file), "whole");
  EXPECT_EQ(file_status(file)->permissions, 0600u);
  fs::create_symlink(file, folder.file("link"));
  EXPECT_FALSE(open_file(folder.file("link"), OpenMode::replace).is_open()) << "a link is not followed";
  EXPECT_EQ(text_of(file), "whole");
}

TEST(File, ReportsStatus) {
  const Folder folder;
  const std::string file = folder.file("a");
  const std::int64_t before = file_clock_nanoseconds();
  ASSERT_TRUE(replace_file(file, "12345", 0644).ok());
  fs::create_symlink(file, folder.file("link"));
  struct stat info {};
  ASSERT_EQ(stat(file.c_str(), &info), 0);
  const auto status = file_status(folder.file("link"));
  ASSERT_TRUE(status);
  EXPECT_TRUE(status->file && !status->folder);
  EXPECT_EQ(status->size, 5u);
  EXPECT_EQ(status->inode, info.st_ino);
  EXPECT_EQ(status->owner, user_id());
  EXPECT_NEAR(static_cast<double>(status->modified - before), 0, 20e9);
  EXPECT_FALSE(link_status(folder.file("link"))->file);
  EXPECT_TRUE(file_status(folder.path.string())->folder);
  EXPECT_FALSE(file_status(folder.file("none")));
}

TEST(File, ALockHasOneOwner) {
  const Folder folder;
  const std::string file = folder.file("lock");
  {
    const Result<Descriptor> first = lock_file(file);
    ASSERT_TRUE(first.ok() && first->is_open());
    const Result<Descriptor> second = lock_file(file);
    ASSERT_TRUE(second.ok());
    EXPECT_FALSE(second->is_open());
  }
  const Result<Descriptor> third = lock_file(file);
  EXPECT_TRUE(third.ok() && third->is_open()) << "free after its owner has closed it";
  EXPECT_FALSE(lock_file(folder.file("no/folder")).ok());
}

TEST(VirtualMemory, CommittedPartIsWritable) {
  constexpr std::size_t kSize = std::size_t{1} << 30;
  std::byte* const range = reserve_memory(kSize);
  ASSERT_NE(range, nullptr);
  std::byte* const middle = range + kSize / 2;
  ASSERT_TRUE(commit_memory(middle, 1 << 20));
  prefer_large_pages(middle, 1 << 20);
  middle[0] = std::byte{7};
  middle[(1 << 20) - 1] = std::byte{8};
  EXPECT_EQ(middle[0], std::byte{7});
  release_memory(range, kSize);
}

TEST(LocalSocket, TransfersBytesBothWaysWithoutBlocking) {
  const Folder folder;
  const std::string path = folder.file("s");
  EXPECT_EQ(find_listener(path), Listener::unknown);
  const Result<Descriptor> listener = listen_local(path);
  ASSERT_TRUE(listener.ok()) << listener.error();
  EXPECT_EQ(find_listener(path), Listener::present);
  EXPECT_FALSE(accept_connection(-1).is_open());
  Descriptor probe = accept_connection(listener->fd());  // the connection of find_listener()
  const Result<Descriptor> near = connect_local(path, 1);
  ASSERT_TRUE(near.ok()) << near.error();
  const Descriptor far = accept_connection(listener->fd());
  ASSERT_TRUE(far.is_open());
  EXPECT_EQ(peer_user(far), user_id());
  std::array<char, 16> bytes{};
  EXPECT_EQ(receive_bytes(far.fd(), bytes.data(), bytes.size()), -1);
  EXPECT_EQ(errno, EAGAIN);
  EXPECT_EQ(send_bytes(near->fd(), "hello"), 5);
  EXPECT_EQ(receive_bytes(far.fd(), bytes.data(), bytes.size()), 5);
  EXPECT_EQ(accept_connection(listener->fd()).fd(), -1);
  EXPECT_EQ(errno, EAGAIN);
}

TEST(Udp, ReadsBatches) {
  const Result<UdpSocket> in = open_udp({0x7f000001, 0});
  ASSERT_TRUE(in.ok());
  UdpSender out;
  EXPECT_NE(out.send(in->local(), std::string("closed")), 0);
  ASSERT_TRUE(out.open().ok());
  for (int i = 0; i < 20; i++) EXPECT_EQ(out.send(in->local(), std::to_string(i)), 0);
  DatagramReader reader;
  int next = 0;
  for (std::span<const Datagram> got = reader.read(in->fd()); !got.empty(); got = reader.read(in->fd())) {
    EXPECT_LE(got.size(), DatagramReader::kMaxBatch);
    for (const Datagram& d : got) EXPECT_EQ(std::string(d.data, d.size), std::to_string(next++));
  }
  EXPECT_EQ(next, 20);
}

// Linux reports it when the ICMP error arrives, POSIX at the next send to the same target.
TEST(Udp, ReportsUndeliveredDatagramAndSendsTheNext) {
  system::Endpoint closed_port;
  {
    const Result<UdpSocket> closes = open_udp({0x7f000001, 0});
    ASSERT_TRUE(closes.ok());
    closed_port = closes->local();
  }
  const Result<UdpSocket> other = open_udp({0x7f000001, 0});
  UdpSender out;
  ASSERT_TRUE(out.open().ok());
  EXPECT_FALSE(out.next_failure());
  for (int i = 0; i < 3; i++) {
    EXPECT_EQ(out.send(closed_port, std::string("a")), 0);
    EXPECT_EQ(out.send(other->local(), std::string("b")), 0);
  }
  int failures = 0;
  while (const std::optional<SendFailure> failure = out.next_failure()) {
    EXPECT_EQ(failure->to, closed_port);
    EXPECT_EQ(failure->error, ECONNREFUSED);
    failures++;
  }
  EXPECT_EQ(failures, is_portable() ? 2 : 3);
  DatagramReader reader;
  EXPECT_EQ(reader.read(other->fd()).size(), 3u);
  // A program that listens again receives the next datagram.
  const Result<UdpSocket> back = open_udp(closed_port);
  ASSERT_TRUE(back.ok()) << back.error();
  EXPECT_EQ(out.send(closed_port, std::string("c")), 0);
  EXPECT_EQ(reader.read(back->fd()).size(), 1u);
}

TEST(Udp, ManyTargetsNeedFewDescriptors) {
  UdpSender out;
  ASSERT_TRUE(out.open().ok());
  const Result<UdpSocket> in = open_udp({0x7f000001, 0});
  const auto open_now = [] { return std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()); };
  const auto before = open_now();
  for (std::uint16_t port = 20000; port < 20500; port++) (void)out.send({0x7f000002, port}, std::string("a"));
  EXPECT_LE(open_now() - before, 128);
  EXPECT_EQ(out.send(in->local(), std::string("a")), 0);
  DatagramReader reader;
  EXPECT_EQ(reader.read(in->fd()).size(), 1u);
}

TEST(FolderEvents, ReportChanges) {
  const Folder folder;
  FolderEvents events;
  EXPECT_EQ(events.available(), !is_portable());
  EXPECT_EQ(reports_changes(folder.path.string()), !is_portable());
  const int number = events.add(folder.path.string());
  EXPECT_EQ(number >= 0, !is_portable());
  std::ofstream(folder.file("a")) << "1";
  if (is_portable()) {
    EXPECT_EQ(events.fd(), -1);
    EXPECT_TRUE(events.read().empty()) << "the caller must poll";
    return;
  }
  EXPECT_TRUE(readable(events.fd()));
  const std::vector<FolderEvent> list = events.read();
  ASSERT_EQ(list.size(), 2u) << "created, written";
  for (const FolderEvent& event : list) {
    EXPECT_EQ(event.folder, number);
    EXPECT_EQ(event.name, "a");
    EXPECT_FALSE(event.folder_removed || event.entry_is_folder);
  }
  EXPECT_TRUE(list[0].may_be_open);
  EXPECT_FALSE(list[1].may_be_open);
  events.remove(number);
}

}  // namespace
}  // namespace limber::system
