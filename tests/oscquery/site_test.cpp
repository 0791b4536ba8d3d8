// The server of the documentation: files of a folder and nothing else, for browsers on this machine.
#include "net/oscquery/site_server.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "net/oscquery/site_response.h"
#include "oscquery/web_client.h"

namespace limber::oscquery::test {
namespace {

namespace fs = std::filesystem;

// A site with a secret file beside it.
class Site {
 public:
  Site() {
    static int count = 0;
    root_ = fs::temp_directory_path() / ("limber_site_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
    write("site/index.html", "<h1>Limber</h1>");
    write("site/learn/index.html", "<h1>Learn</h1>");
    write("site/learn/a b.html", "blank");
    write("site/media/arm.png", "PNG");
    write("site/.hidden", "hidden");
    write("secret.txt", "secret");
    write("sites/other.txt", "other");
    fs::create_symlink(root_ / "secret.txt", root_ / "site/link.txt");
    fs::create_directory_symlink(root_ / "sites", root_ / "site/linked");
    fs::create_symlink(root_ / "site/index.html", root_ / "site/inside.html");
  }
  ~Site() {
    std::error_code ignored;
    fs::remove_all(root_, ignored);
  }
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  std::string folder() const { return fs::canonical(root_ / "site").string(); }

 private:
  void write(const std::string& name, const std::string& text) const {
    fs::create_directories((root_ / name).parent_path());
    std::ofstream(root_ / name) << text;
  }
  fs::path root_;
};

HttpResponse response_to(const Site& site, const std::string& target, const std::string& method = "GET") {
  HttpRequest request;
  request.method = method;
  request.target = target;
  request.host = "127.0.0.1:9010";
  return respond_from_folder(request, site.folder());
}

TEST(Site, ServesFilesAndIndexPages) {
  const Site site;
  EXPECT_EQ(response_to(site, "/").body, "<h1>Limber</h1>");
  EXPECT_EQ(response_to(site, "/index.html").body, "<h1>Limber</h1>");
  EXPECT_EQ(response_to(site, "/learn/").body, "<h1>Learn</h1>");
  EXPECT_EQ(response_to(site, "/learn/a%20b.html").body, "blank");
  EXPECT_EQ(response_to(site, "/media/arm.png?version=2#top").body, "PNG");
  EXPECT_EQ(response_to(site, "/inside.html").body, "<h1>Limber</h1>") << "a link within the folder";
}

TEST(Site, ServesNothingOutsideOfTheFolder) {
  const Site site;
  for (const char* target : {"/../secret.txt",
                             "/learn/../../secret.txt",
                             "/%2e%2e/secret.txt",
                             "/..%2fsecret.txt",
                             "/%2E%2E%2Fsecret.txt",
                             "/link.txt",
                             "/linked/other.txt",
                             "/.hidden",
                             "/../sites/other.txt",
                             "//etc/passwd",
                             "/etc/passwd",
                             "/index.html%00.png",
                             "/..%5csecret.txt",
                             "secret.txt",
                             "",
                             "*",
                             "/learn",
                             "/media/",
                             "/nowhere.html",
                             "http://127.0.0.1/../secret.txt"}) {
    const HttpResponse response = response_to(site, target);
    EXPECT_EQ(response.status, 404) << target;
    EXPECT_NE(response.body.find("Page not found"), std::string::npos) << target;
    EXPECT_EQ(response.body.find("secret\n"), std::string::npos) << target;
  }
}

TEST(Site, AcceptsGetAndHeadOnly) {
  const Site site;
  EXPECT_EQ(response_to(site, "/", "HEAD").status, 200);
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "TRACE", "get"})
    EXPECT_EQ(response_to(site, "/", method).status, 405) << method;
}

TEST(Site, RejectsNamesAndPagesOfOtherHosts) {
  const Site site;
  HttpRequest request;
  request.method = "GET";
  request.target = "/";
  EXPECT_EQ(respond_from_folder(request, site.folder()).status, 400) << "without a Host header";
  request.host = "evil.example";
  EXPECT_EQ(respond_from_folder(request, site.folder()).status, 403) << "DNS rebinding";
  request.host = "localhost:9010";
  EXPECT_EQ(respond_from_folder(request, site.folder()).status, 200);
  request.origin = "http://evil.example";
  EXPECT_EQ(respond_from_folder(request, site.folder()).status, 403);
}

TEST(Site, KnowsTheContentTypesOfTheDocumentation) {
  EXPECT_EQ(content_type("a/index.html"), "text/html; charset=utf-8");
  EXPECT_EQ(content_type("style.css"), "text/css; charset=utf-8");
  EXPECT_EQ(content_type("search.js"), "text/javascript; charset=utf-8");
  EXPECT_EQ(content_type("plot.svg"), "image/svg+xml");
  EXPECT_EQ(content_type("film.webp"), "image/webp");
  EXPECT_EQ(content_type("noextension"), "application/octet-stream");
}

TEST(SiteServer, AnswersOnOneConnection) {
  const Site site;
  SiteServer server;
  ASSERT_TRUE(server.start(site.folder(), 0).ok());
  WebClient client(server.port());
  const Reply page = client.get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.body, "<h1>Limber</h1>");
  EXPECT_TRUE(page.has_header("Content-Type: text/html; charset=utf-8\r\n"));
  EXPECT_TRUE(page.has_header("X-Content-Type-Options: nosniff\r\n"));
  EXPECT_TRUE(page.has_header("Content-Security-Policy: default-src 'self'"));
  EXPECT_TRUE(client.get("/media/arm.png").has_header("Content-Type: image/png\r\n"));
  const Reply head = client.get("/", "", "HEAD");
  EXPECT_TRUE(head.has_header("Content-Length: 15\r\n"));
  EXPECT_EQ(head.body, "");
  EXPECT_EQ(client.get("/%2e%2e/secret.txt").status, 404);
  const Reply post = client.get("/", "", "POST");
  EXPECT_EQ(post.status, 405);
  EXPECT_TRUE(post.has_header("Allow: GET, HEAD\r\n"));
  EXPECT_EQ(client.get("/", "Connection: Upgrade\r\nUpgrade: websocket\r\n").status, 200) << "there is no WebSocket";
}

TEST(SiteServer, SurvivesMalformedRequests) {
  const Site site;
  SiteServer server;
  ASSERT_TRUE(server.start(site.folder(), 0).ok());
  for (const std::string& request : {std::string("nonsense\r\n\r\n"), std::string("GET / HTTP/9.9\r\n\r\n"),
                                     "GET /" + std::string(20000, 'a') + " HTTP/1.1\r\n\r\n",
                                     std::string("GET / HTTP/1.1\r\nContent-Length: 999999999999\r\n\r\n")}) {
    WebClient client(server.port());
    EXPECT_TRUE(client.send(request));
    EXPECT_GE(client.reply().status, 400) << request.substr(0, 40);
  }
  { WebClient(server.port()).send("GET / HT"); }  // ends in the middle
  EXPECT_EQ(WebClient(server.port()).get("/").status, 200);
}

TEST(SiteServer, ListensOnLoopbackOnly) {
  const Site site;
  SiteServer server;
  ASSERT_TRUE(server.start(site.folder(), 0).ok());
  sockaddr_in own{};
  own.sin_family = AF_INET;
  own.sin_port = htons(server.port());
  own.sin_addr.s_addr = htonl(INADDR_LOOPBACK + 1);  // 127.0.0.2 would be in use if it listened on every address
  const int fd = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  EXPECT_EQ(bind(fd, reinterpret_cast<const sockaddr*>(&own), sizeof own), 0);
  ::close(fd);
}

TEST(SiteServer, ReportsAPortInUseAndAMissingFolder) {
  const Site site;
  SiteServer first;
  ASSERT_TRUE(first.start(site.folder(), 0).ok());
  SiteServer second;
  const Result<void> taken = second.start(site.folder(), first.port());
  ASSERT_FALSE(taken.ok());
  EXPECT_EQ(taken.error(),
            "can't listen on 127.0.0.1:" + std::to_string(first.port()) + " (TCP): Address already in use");
  EXPECT_EQ(second.port(), 0);
  const Result<void> missing = second.start(site.folder() + "/nowhere", 0);
  ASSERT_FALSE(missing.ok());
  EXPECT_EQ(missing.error(), site.folder() + "/nowhere: there is no folder of this name");
  const std::uint16_t port = first.port();
  first.stop();
  first.stop();
  EXPECT_EQ(first.port(), 0);
  EXPECT_TRUE(second.start(site.folder(), port).ok()) << "the port is free again";
}

}  // namespace
}  // namespace limber::oscquery::test
