// The console server with an engine: access, results, and robustness against misbehaving clients.
#include "net/console/server.h"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <map>

#include "base/log/log.h"
#include "base/random.h"
#include "base/system/net/local_socket.h"
#include "console/private_folder.h"
#include "engine/show.h"
#include "net/console/console_client.h"

namespace limber::console {
namespace {

using engine::test::fast_options;
using engine::test::SceneFile;
using engine::test::Show;
using Kind = ConsoleLine::Kind;

constexpr int kMaxPolls = 60000;  // max. number of polls; reached only by failing tests

constexpr const char* kScene = R"(
ball = sim:add_body("ball"):add_part("ball", sim:add_sphere_shape("ball", 1), { mass = 0 })
state.n = 0
sim:on_step(function() state.n = state.n + 1 end)
)";

engine::EngineOptions quiet(const std::string& scene) {
  engine::EngineOptions options = fast_options(scene);
  options.print = false;
  return options;
}

struct ServerTest : testing::Test {
  ServerTest() {
    log_to_stderr(false);
    testing::internal::CaptureStderr();  // output of scripts
  }
  ~ServerTest() override {
    server.stop();
    testing::internal::GetCapturedStderr();
    log_to_stderr(true);
  }

  void start() {
    const Result<void> started = server.start();
    ASSERT_TRUE(started.ok()) << started.error();
  }
  ConsoleClient connect() {
    Result<system::Descriptor> connection = connect_console(server.path());
    EXPECT_TRUE(connection.ok()) << (connection.ok() ? "" : connection.error());
    return ConsoleClient(connection ? std::move(*connection) : system::Descriptor());
  }
  /// A console that has received its first line.
  ConsoleClient connect_and_greet() {
    ConsoleClient link = connect();
    EXPECT_EQ(next(link).kind, Kind::hello);
    return link;
  }
  /// Returns the next line while the engine ticks.
  ConsoleLine next(ConsoleClient& link) {
    for (int i = 0; i < kMaxPolls && !link.ended(); i++) {
      if (std::optional<ConsoleLine> line = link.next(1)) return *line;
      show.ticks(1);
    }
    EXPECT_TRUE(link.ended()) << "no line received";
    ConsoleLine end;
    end.kind = Kind::rejected;
    end.text = "ended";
    return end;
  }
  std::string evaluate(ConsoleClient& link, const std::string& text) {
    EXPECT_TRUE(link.send({++id, ConsoleRequest::Kind::evaluate, text}));
    const ConsoleLine line = next(link);
    EXPECT_EQ(line.id, id);
    return line.text;
  }

  PrivateFolder folder;
  SceneFile scene{kScene};
  Show show{quiet(scene.path())};
  ConsoleServer server{show.link, {.folder = folder.path(), .scene = "scene.lua"}};
  std::uint64_t id = 0;
};

TEST_F(ServerTest, GreetsAndAnswers) {
  start();
  ConsoleClient link = connect();
  const ConsoleLine hello = next(link);
  EXPECT_EQ(hello.kind, Kind::hello);
  EXPECT_EQ(hello.text, "scene.lua");
  EXPECT_EQ(hello.pid, getpid());
  EXPECT_EQ(hello.version.substr(0, 2), "0.");
  EXPECT_EQ(evaluate(link, "1 + 1"), "2");
  EXPECT_EQ(evaluate(link, "ball.position = vec3(0, 0, 9)"), "");
  EXPECT_NEAR(show.read("/physics/body/ball/part/ball/position", 2), 9, 0.2);
  EXPECT_TRUE(evaluate(link, "nothing").starts_with("console:1: there is no global 'nothing'"));
  EXPECT_TRUE(link.send({50, ConsoleRequest::Kind::evaluate, "for"}));
  EXPECT_EQ(next(link).kind, Kind::incomplete);
  EXPECT_TRUE(link.send({51, ConsoleRequest::Kind::complete, "sim.ti"}));
  const ConsoleLine names = next(link);
  EXPECT_EQ(names.names, (std::vector<std::string>{"tick", "time", "timestep"}));
  EXPECT_EQ(names.word, 2U);
}

TEST_F(ServerTest, TheSocketExistsWhileItRuns) {
  EXPECT_EQ(server.path(), "");
  // the socket of a program that has died
  const std::string dead = socket_path(folder.path(), 1 << 30);
  { const Result<system::Descriptor> closes = system::listen_local(dead); }
  start();
  const std::string path = server.path();
  EXPECT_EQ(path, socket_path(folder.path(), getpid()));
  EXPECT_FALSE(std::filesystem::exists(dead));
  EXPECT_EQ(console_sockets(folder.path()).size(), 1U);
  ConsoleClient link = connect_and_greet();
  server.stop();
  EXPECT_FALSE(std::filesystem::exists(path));
  EXPECT_EQ(next(link).text, "ended");
  start();
  ConsoleClient again = connect_and_greet();
  EXPECT_EQ(evaluate(again, "1"), "1");
}

TEST_F(ServerTest, AnUnusableFolderHasAReason) {
  ConsoleServer nowhere(show.link, {.folder = "/nowhere/at/all", .scene = ""});
  EXPECT_EQ(nowhere.start().error(), socket_path("/nowhere/at/all", getpid()) + ": No such file or directory");
  nowhere.stop();
}

TEST_F(ServerTest, AnotherUserIsRejected) {
  ConsoleServer others(show.link,
                       {.folder = folder.path(), .scene = "", .allowed_user = static_cast<long>(geteuid()) + 1});
  ASSERT_TRUE(others.start().ok());
  const std::uint64_t warnings = log_count(LogLevel::warning);
  Result<system::Descriptor> connection = connect_console(others.path());
  ASSERT_TRUE(connection.ok());
  ConsoleClient link(std::move(*connection));
  link.send({1, ConsoleRequest::Kind::evaluate, "ball:remove()"});
  EXPECT_EQ(next(link).text, "ended") << "no first line";
  show.ticks(3);
  EXPECT_EQ(show.read("/physics/body/ball/enabled"), 1);
  EXPECT_EQ(log_count(LogLevel::warning), warnings + 1);
}

TEST_F(ServerTest, OutputOfARequestPrecedesItsResult) {
  start();
  ConsoleClient link = connect_and_greet();
  ConsoleClient other = connect_and_greet();
  EXPECT_TRUE(link.send({7, ConsoleRequest::Kind::evaluate, "print('a', 1) warn('b') return 3"}));
  ConsoleLine line = next(link);
  EXPECT_EQ(line.kind, Kind::print);
  EXPECT_EQ(line.text, "a\t1");
  EXPECT_EQ(line.id, 7U);
  line = next(link);
  EXPECT_EQ(line.kind, Kind::warning);
  EXPECT_EQ(line.text, "b");
  EXPECT_EQ(line.id, 7U);
  EXPECT_EQ(next(link).text, "3");
  // the other console receives it too, like any printed text
  line = next(other);
  EXPECT_EQ(line.kind, Kind::print);
  EXPECT_EQ(line.text, "a\t1");
  EXPECT_EQ(line.id, 0U);
  EXPECT_EQ(next(other).kind, Kind::warning);
}

TEST_F(ServerTest, SendsTheLogSinceTheConnection) {
  log_warning("before");
  start();
  ConsoleClient link = connect_and_greet();
  log_info("not for consoles");
  log_error("a fault\nof two lines");
  ConsoleLine line = next(link);
  EXPECT_EQ(line.kind, Kind::fault);
  EXPECT_EQ(line.text, "a fault\nof two lines");
  // more than the log's capacity: dropped lines are counted
  constexpr int kLines = 5000;
  for (int i = 0; i < kLines; i++) log_line(LogLevel::print, "flood");
  log_warning("last");
  std::uint64_t printed = 0;
  std::uint64_t missed = 0;
  while ((line = next(link)).kind != Kind::warning) {
    printed += line.kind == Kind::print ? 1 : 0;
    missed += line.count;
    ASSERT_NE(line.kind, Kind::rejected);
  }
  EXPECT_EQ(printed + missed, static_cast<std::uint64_t>(kLines));
}

TEST_F(ServerTest, AcceptsEightConnections) {
  start();
  std::vector<ConsoleClient> links;
  for (std::size_t i = 0; i < ConsoleServer::kMaxConnections; i++) links.push_back(connect_and_greet());
  ConsoleClient ninth = connect();
  const ConsoleLine line = next(ninth);
  EXPECT_EQ(line.kind, Kind::rejected);
  EXPECT_EQ(line.text, "8 consoles are open already; close one");
  for (ConsoleClient& link : links) EXPECT_EQ(evaluate(link, "2 * 2"), "4");
  links.pop_back();
  // its slot is free when the server has noticed that it left
  for (int i = 0; i < kMaxPolls; i++) {
    ConsoleClient next_one = connect();
    if (next(next_one).kind == Kind::hello) return;
  }
  ADD_FAILURE() << "the slot was not freed";
}

TEST_F(ServerTest, GarbageIsAnsweredAndTheNextLineWorks) {
  start();
  ConsoleClient link = connect_and_greet();
  const std::string garbage = "hello\n\xff\xfe\n[[[[\n{\"evaluate\":3}\n\r\n\n";
  ASSERT_EQ(send(link.fd(), garbage.data(), garbage.size(), 0), static_cast<ssize_t>(garbage.size()));
  for (int i = 0; i < 4; i++) {
    const ConsoleLine line = next(link);
    EXPECT_EQ(line.kind, Kind::error);
    EXPECT_EQ(line.id, 0U);
  }
  EXPECT_EQ(evaluate(link, "'still here'"), "still here");
}

TEST_F(ServerTest, ATooLongLineIsRejected) {
  start();
  ConsoleClient link = connect_and_greet();
  ConsoleClient other = connect_and_greet();
  const std::string much(65536, 'x');
  std::size_t sent = 0;
  while (sent < 4 * kMaxLine) {
    const ssize_t n = send(link.fd(), much.data(), much.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n < 0 && errno != EAGAIN) break;
    if (n > 0) sent += static_cast<std::size_t>(n);
    if (n < 0) show.ticks(1);
  }
  EXPECT_LT(sent, 4 * kMaxLine) << "the connection was closed";
  EXPECT_EQ(evaluate(other, "'still here'"), "still here");
  // the longest accepted text, with every byte escaped
  const std::string longest = "--" + std::string(kMaxEvaluatedBytes - 2, '\x01');
  EXPECT_EQ(evaluate(other, longest), "");
  EXPECT_EQ(evaluate(other, longest + "x"), "the text must have at most 65536 bytes, got 65537");
}

TEST_F(ServerTest, ASlowReaderDoesNotDelayOthers) {
  start();
  ConsoleClient slow = connect_and_greet();
  ConsoleClient other = connect_and_greet();
  // sends requests without reading until the connection blocks
  std::uint64_t request_count = 0;
  std::string rest;
  for (int quiet = 0; quiet < 200;) {
    if (rest.empty()) rest = request_line({++request_count, ConsoleRequest::Kind::evaluate, "('x'):rep(60000)"});
    const ssize_t n = send(slow.fd(), rest.data(), rest.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (n > 0) rest.erase(0, static_cast<std::size_t>(n));
    quiet = n > 0 ? 0 : quiet + 1;
    if (n < 0) {
      EXPECT_EQ(evaluate(other, "1"), "1") << "other consoles are answered meanwhile";
    }
    ASSERT_LT(request_count, 100000U) << "the server must stop reading at some point";
  }
  // afterwards it reads all results in order
  for (std::uint64_t i = 1; i < request_count; i++) {
    const ConsoleLine line = next(slow);
    ASSERT_EQ(line.id, i);
    ASSERT_EQ(line.text.size(), 60000U);
  }
}

TEST_F(ServerTest, BrokenConnectionsAreRemoved) {
  start();
  for (int i = 0; i < 300; i++) {
    ConsoleClient link = connect();
    if (i % 2 == 0) link.send({1, ConsoleRequest::Kind::evaluate, "state.left = (state.left or 0) + 1"});
    if (i % 3 == 0) show.ticks(1);
  }
  for (int i = 0; i < kMaxPolls; i++) {
    ConsoleClient link = connect();
    const ConsoleLine line = next(link);
    if (line.kind != Kind::hello) continue;
    EXPECT_EQ(evaluate(link, "state.n > 0"), "true");
    return;
  }
  ADD_FAILURE() << "no connection is accepted any more";
}

TEST_F(ServerTest, AHalfClosedConnectionIsAnswered) {
  start();
  ConsoleClient link = connect_and_greet();
  const std::string requests =
      "{\"id\":1,\"evaluate\":\"1\"}\n{\"id\":2,\"evaluate\":\"2\"}";  // no line feed at the end
  ASSERT_EQ(send(link.fd(), requests.data(), requests.size(), 0), static_cast<ssize_t>(requests.size()));
  shutdown(link.fd(), SHUT_WR);
  EXPECT_EQ(next(link).text, "1");
  EXPECT_EQ(next(link).text, "2");
  EXPECT_EQ(next(link).text, "ended");
}

TEST_F(ServerTest, InvalidInputDoesNotChangeTheRun) {
  const auto plain = [&] {
    Show alone(quiet(scene.path()));
    while (alone.engine.world().tick() < 400) alone.ticks(1);
    return alone.engine.state_hash();
  };
  start();
  Random random(11, "console");
  std::vector<ConsoleClient> links;
  const std::string good = request_line({1, ConsoleRequest::Kind::evaluate, "state.hash = nil"});
  while (show.engine.world().tick() < 400) {
    if (links.size() < 4) links.push_back(connect());
    ConsoleClient& link = links[static_cast<std::size_t>(random.uniform() * static_cast<double>(links.size()))];
    std::string bytes;
    for (int i = 0; i < 64; i++) bytes += static_cast<char>(static_cast<int>(random.uniform() * 256));
    if (random.uniform() < 0.5) bytes = good.substr(0, static_cast<std::size_t>(random.uniform() * 30)) + bytes;
    (void)send(link.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (random.uniform() < 0.1) links.erase(links.begin());
    show.ticks(1);
  }
  EXPECT_EQ(show.engine.state_hash(), plain());
  EXPECT_EQ(show.engine.faults(), 0U);
  links.clear();
  for (int i = 0; i < kMaxPolls; i++) {
    ConsoleClient link = connect();
    if (next(link).kind != Kind::hello) continue;
    EXPECT_EQ(evaluate(link, "'well'"), "well");
    return;
  }
  ADD_FAILURE() << "no connection is accepted any more";
}

}  // namespace
}  // namespace limber::console
