// `limber docs`: serves the pages of the installation, opens a browser, ends with a signal.
#include <fcntl.h>
#include <sys/stat.h>

#include "app/program.h"
#include "oscquery/web_client.h"

namespace limber::app::test {
namespace {

using oscquery::test::WebClient;

// An installation with pages, and a folder for programs in front of PATH.
struct DocsFixture {
  TempFolder folder;
  std::string program = install_copy(folder);

  DocsFixture() { folder.file("share/doc/limber/html/index.html", "<h1>Limber</h1>"); }

  std::vector<std::string> command(const std::string& display, const std::vector<std::string>& args) const {
    std::vector<std::string> words = {
        "env",   "-u",  "WAYLAND_DISPLAY", "DISPLAY=" + display, "PATH=" + folder.path() + "/programs:/usr/bin:/bin",
        program, "docs"};
    words.insert(words.end(), args.begin(), args.end());
    return words;
  }
};

// The port in the printed address.
std::uint16_t printed_port(Process& docs) {
  EXPECT_TRUE(docs.wait_for("/\n", true)) << docs.err();
  const std::string before = "http://127.0.0.1:";
  EXPECT_TRUE(docs.out().starts_with(before)) << docs.out();
  return static_cast<std::uint16_t>(std::atoi(docs.out().c_str() + before.size()));
}

TEST(DocsCommand, ServesThePagesUntilASignal) {
  const DocsFixture fixture;
  Process docs(fixture.command("", {"--port", "0", "--no-browser"}));
  const std::uint16_t port = printed_port(docs);
  EXPECT_EQ(WebClient(port).get("/").body, "<h1>Limber</h1>");
  EXPECT_EQ(WebClient(port).get("/nowhere").status, 404);
  docs.signal(SIGINT);
  const RunResult result = docs.finish();
  EXPECT_EQ(result.code, 0) << result.err;
  EXPECT_NE(result.err.find("/share/doc/limber/html; Ctrl+C ends\n"), std::string::npos) << result.err;
}

TEST(DocsCommand, OpensTheAddressInABrowser) {
  const DocsFixture fixture;
  const std::string pipe = fixture.folder.path() + "/pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  const std::string browser = fixture.folder.file("programs/xdg-open", "#!/bin/sh\necho \"$1\" >" + pipe + "\n");
  std::filesystem::permissions(browser, std::filesystem::perms::owner_all);
  Process docs(fixture.command(":9", {"--port", "0"}));
  const std::uint16_t port = printed_port(docs);
  EXPECT_EQ(content(pipe), fmt::format("http://127.0.0.1:{}/\n", port)) << "reading waits for the browser";
  docs.signal(SIGTERM);
  EXPECT_EQ(docs.finish().code, 0);
}

TEST(DocsCommand, OpensNoBrowserWithoutADisplay) {
  const DocsFixture fixture;
  const std::string browser =
      fixture.folder.file("programs/xdg-open", "#!/bin/sh\ntouch '" + fixture.folder.path() + "/opened'\n");
  std::filesystem::permissions(browser, std::filesystem::perms::owner_all);
  for (const std::vector<std::string>& args :
       {std::vector<std::string>{"--port", "0"}, std::vector<std::string>{"--port", "0", "--no-browser"}}) {
    const bool display = args.size() == 3;
    Process docs(fixture.command(display ? ":9" : "", args));
    const std::uint16_t port = printed_port(docs);
    // the browser would be started before this signal is read
    EXPECT_EQ(WebClient(port).get("/").status, 200);
    docs.signal(SIGTERM);
    EXPECT_EQ(docs.finish().code, 0);
    EXPECT_FALSE(std::filesystem::exists(fixture.folder.path() + "/opened"));
  }
}

TEST(DocsCommand, ReportsAPortInUse) {
  const DocsFixture fixture;
  Process first(fixture.command("", {"--port", "0"}));
  const std::string port = std::to_string(printed_port(first));
  const RunResult second = Process(fixture.command("", {"--port", port})).finish();
  EXPECT_EQ(second.code, 3);
  EXPECT_EQ(second.err, "limber: docs: can't listen on 127.0.0.1:" + port +
                            " (TCP): Address already in use. Choose another port with --port, or a free one with "
                            "--port 0\n");
}

TEST(DocsCommand, ChoosesAFreePortIfTheDefaultIsInUse) {
  const DocsFixture fixture;
  Process first(fixture.command("", {}));
  const std::uint16_t port = printed_port(first);
  Process second(fixture.command("", {}));
  EXPECT_NE(printed_port(second), port);
}

TEST(DocsCommand, ReportsMissingPages) {
  const TempFolder folder;
  const std::string program = install_copy(folder);
  const RunResult result = Process({program, "docs", "--port", "0"}).finish();
  EXPECT_EQ(result.code, 3);
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err.find("the pages of the documentation are not installed"), std::string::npos) << result.err;
  EXPECT_NE(result.err.find("mkdocs build"), std::string::npos) << result.err;
}

}  // namespace
}  // namespace limber::app::test
