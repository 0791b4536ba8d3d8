// The console protocol: round trips between both ends, and arbitrary input.
#include "net/console/protocol.h"

#include <gtest/gtest.h>

#include "base/random.h"

namespace limber::console {
namespace {

using Kind = ConsoleLine::Kind;

// a line as its reader gets it; every line ends with exactly one line feed
std::string without_line_feed(const std::string& line) {
  EXPECT_EQ(line.find('\n'), line.size() - 1) << line;
  return line.substr(0, line.size() - 1);
}

ConsoleLine read(const std::string& line) {
  const Result<ConsoleLine> read = parse_line(without_line_feed(line));
  EXPECT_TRUE(read.ok()) << line;
  return read ? *read : ConsoleLine{};
}

TEST(Protocol, LinesMatchTheDocumentation) {
  EXPECT_EQ(request_line({7, ConsoleRequest::Kind::evaluate, "sim.time"}), "{\"evaluate\":\"sim.time\",\"id\":7}\n");
  EXPECT_EQ(request_line({8, ConsoleRequest::Kind::complete, "sim.ti"}), "{\"complete\":\"sim.ti\",\"id\":8}\n");
  EXPECT_EQ(hello_line("0.2.0", 42, "scripts/arms.lua"),
            "{\"limber\":\"0.2.0\",\"pid\":42,\"scene\":\"scripts/arms.lua\"}\n");
  EXPECT_EQ(result_line(7, {Evaluation::Kind::value, "1.5"}), "{\"id\":7,\"value\":\"1.5\"}\n");
  EXPECT_EQ(result_line(7, {}), "{\"done\":true,\"id\":7}\n");
  EXPECT_EQ(result_line(7, {Evaluation::Kind::incomplete, ""}), "{\"id\":7,\"incomplete\":true}\n");
  EXPECT_EQ(result_line(7, {Evaluation::Kind::error, "no"}), "{\"error\":\"no\",\"id\":7}\n");
  EXPECT_EQ(result_line(8, {Evaluation::Kind::names, "tick\ntime", 2}),
            "{\"id\":8,\"names\":[\"tick\",\"time\"],\"word\":2}\n");
  EXPECT_EQ(log_line(0, {1, LogLevel::print, "hi"}), "{\"print\":\"hi\"}\n");
  EXPECT_EQ(log_line(7, {1, LogLevel::warning, "oh"}), "{\"id\":7,\"warning\":\"oh\"}\n");
  EXPECT_EQ(log_line(0, {1, LogLevel::error, "ah"}), "{\"fault\":\"ah\"}\n");
  EXPECT_EQ(missed_line(3), "{\"missed\":3}\n");
  EXPECT_EQ(rejected_line("full"), "{\"refused\":\"full\"}\n");
}

TEST(Protocol, SubscribesAndReports) {
  using RequestKind = ConsoleRequest::Kind;
  EXPECT_EQ(request_line({3, RequestKind::traffic, "/a"}), "{\"id\":3,\"of\":\"/a\",\"watch\":\"traffic\"}\n");
  const Result<ConsoleRequest> changes = parse_request(without_line_feed(request_line({4, RequestKind::changes, ""})));
  ASSERT_TRUE(changes.ok());
  EXPECT_EQ(changes->kind, RequestKind::changes);
  EXPECT_EQ(changes->id, 4U);
  EXPECT_EQ(parse_request("{\"watch\":\"birds\"}").error(), "\"watch\" must be \"traffic\" or \"changes\"");
  const ConsoleLine in = read(traffic_line(true, 1.5, "127.0.0.1:5", "/a 1"));
  EXPECT_EQ(in.kind, Kind::in);
  EXPECT_EQ(in.text + "|" + in.origin, "/a 1|127.0.0.1:5");
  EXPECT_EQ(in.time, 1.5);
  EXPECT_EQ(read(traffic_line(false, 0, "x", "/a")).kind, Kind::out);
  const ConsoleLine change = read(change_line(2, "console", "/scene/wind 2 → 4"));
  EXPECT_EQ(change.kind, Kind::change);
  EXPECT_EQ(change.text, "/scene/wind 2 → 4");
  EXPECT_EQ(change.origin, "console");
}

TEST(Protocol, LinesSurviveARoundTrip) {
  const std::string odd = "a\"b\\c\n\td 'é' \xe2\x80\xa6 \x01";
  const Result<ConsoleRequest> request =
      parse_request(without_line_feed(request_line({9007199254740993u, ConsoleRequest::Kind::complete, odd})));
  ASSERT_TRUE(request.ok());
  EXPECT_EQ(request->id, 9007199254740993u);
  EXPECT_EQ(request->kind, ConsoleRequest::Kind::complete);
  EXPECT_EQ(request->text, odd);
  const ConsoleLine hello = read(hello_line("0.2.0", 42, "a scene"));
  EXPECT_EQ(hello.kind, Kind::hello);
  EXPECT_EQ(hello.version + "|" + hello.text, "0.2.0|a scene");
  EXPECT_EQ(hello.pid, 42);
  const ConsoleLine names = read(result_line(3, {Evaluation::Kind::names, "a\nb", 1}));
  EXPECT_EQ(names.names, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(names.word, 1U);
  EXPECT_TRUE(read(result_line(3, {Evaluation::Kind::names, "", 0})).names.empty());
  EXPECT_EQ(read(missed_line(12)).count, 12U);
  for (const auto& [line, kind] : {std::pair{result_line(5, {}), Kind::done},
                                   {result_line(5, {Evaluation::Kind::value, "v"}), Kind::value},
                                   {result_line(5, {Evaluation::Kind::error, "e"}), Kind::error},
                                   {result_line(5, {Evaluation::Kind::incomplete, ""}), Kind::incomplete},
                                   {log_line(5, {1, LogLevel::print, "p"}), Kind::print},
                                   {log_line(5, {1, LogLevel::warning, "w"}), Kind::warning},
                                   {log_line(5, {1, LogLevel::error, "f"}), Kind::fault}}) {
    EXPECT_EQ(read(line).kind, kind) << line;
    EXPECT_EQ(read(line).id, 5U) << line;
  }
}

TEST(Protocol, EscapesControlCharactersOfScripts) {
  EXPECT_EQ(read(result_line(1, {Evaluation::Kind::value, "\x1b[2Jgone\xff"})).text, "\\x1b[2Jgone\\xff");
  EXPECT_EQ(read(result_line(1, {Evaluation::Kind::names, "\x1b[2J"})).names[0], "\\x1b[2J");
  EXPECT_EQ(read(rejected_line("\x07")).text, "\\x07");
}

TEST(Protocol, InvalidRequestsDescribeTheExpectedForm) {
  for (const char* wrong : {"", "sim.time", "{", "[]", "1", "null", "\"x\"", "\xff\xfe", "[[[[[[[[[[[["}) {
    const Result<ConsoleRequest> request = parse_request(wrong);
    ASSERT_FALSE(request.ok()) << wrong;
    EXPECT_EQ(request.error(), "not a request; expected a line of JSON such as {\"id\":1,\"evaluate\":\"sim.time\"}")
        << wrong;
  }
  for (const char* wrong : {"{}", "{\"id\":1}", "{\"evaluate\":1}", "{\"evaluate\":[\"x\"]}",
                            "{\"evaluate\":{\"a\":1}}", "{\"complete\":null,\"evaluate\":\"x\"}"})
    EXPECT_EQ(parse_request(wrong).error(), "a request must have a text in \"evaluate\" or \"complete\"") << wrong;
  // an invalid id becomes 0
  EXPECT_EQ(parse_request("{\"id\":\"seven\",\"evaluate\":\"x\"}")->id, 0U);
  EXPECT_EQ(parse_request("{\"id\":-1,\"evaluate\":\"x\"}")->id, 0U);
  // deep nesting is rejected as fast as a flat object
  EXPECT_FALSE(parse_request(std::string(kMaxLine, '[')).ok());
  EXPECT_FALSE(parse_request("{\"evaluate\":" + std::string(kMaxLine, '{')).ok());
}

TEST(Protocol, ParsesGarbageWithoutHarm) {
  Random random(7, "protocol");
  const std::string good = request_line({1, ConsoleRequest::Kind::evaluate, "print('x')"}) +
                           result_line(2, {Evaluation::Kind::names, "a\nb", 1});
  std::size_t rejected = 0;
  for (int i = 0; i < 6000; i++) {
    std::string line = i % 2 == 0 ? good.substr(0, 1 + static_cast<std::size_t>(random.uniform() * 70)) : "";
    const auto times = 1 + static_cast<int>(random.uniform() * 8);
    for (int k = 0; k < times; k++) {
      const auto byte = static_cast<char>(static_cast<int>(random.uniform() * 256));
      if (line.empty() || i % 2 == 1) {
        line += byte;
      } else {
        line[static_cast<std::size_t>(random.uniform() * static_cast<double>(line.size()))] = byte;
      }
    }
    const Result<ConsoleRequest> request = parse_request(line);
    const Result<ConsoleLine> parsed = parse_line(line);
    rejected += request.ok() ? 0 : 1;
    EXPECT_TRUE(request.ok() || !request.error().empty());
    EXPECT_TRUE(!parsed.ok() || parsed->names.size() <= 2U);
  }
  EXPECT_GT(rejected, 4500U);
}

}  // namespace
}  // namespace limber::console
