// What the port says to plain HTTP, and to handshakes that are not for it.
#include <regex>

#include "tests/service/service_fixture.hpp"

namespace limn::server::testing {
namespace {

const SiteFile kSite[] = {
    {"/index.html", "text/html; charset=utf-8", "\"i1\"", "<p>hello</p>", {}, false},
    {"/assets/app.js", "text/javascript; charset=utf-8", "\"a1\"", "console.log('plain')", "packed", true},
};

TestService::Options withSite() {
  TestService::Options options;
  options.configure = [](ServiceConfig& config) { config.site = kSite; };
  return options;
}

TestService::Options withToken() {
  TestService::Options options;
  options.configure = [](ServiceConfig& config) {
    config.site = kSite;
    config.transport.access.token = "secret-7";
  };
  return options;
}

const std::string kHost = "Host: localhost";

TEST(Http, servesTheSiteFromMemory) {
  TestService server(withSite());
  RawClient client(server.port());
  auto reply = client.request("GET / HTTP/1.1", {kHost});
  EXPECT_EQ(reply.status, 200);
  EXPECT_EQ(reply.body, "<p>hello</p>");
  EXPECT_EQ(reply.headers["content-type"], "text/html; charset=utf-8");
  EXPECT_EQ(reply.headers["etag"], "\"i1\"");
  EXPECT_EQ(reply.headers["x-content-type-options"], "nosniff");
  EXPECT_NE(reply.headers["content-security-policy"].find("default-src 'none'"), std::string::npos);
  EXPECT_NE(reply.headers["content-security-policy"].find("frame-ancestors 'none'"), std::string::npos);
  EXPECT_EQ(reply.headers["content-security-policy"].find("unsafe-"), std::string::npos);
  reply = client.request("GET /assets/app.js HTTP/1.1", {kHost});
  EXPECT_EQ(reply.body, "console.log('plain')");
  EXPECT_NE(reply.headers["cache-control"].find("immutable"), std::string::npos);
  reply = client.request("GET /assets/app.js HTTP/1.1", {kHost, "Accept-Encoding: br, gzip"});
  EXPECT_EQ(reply.body, "packed");
  EXPECT_EQ(reply.headers["content-encoding"], "gzip");
}

TEST(Http, unchangedFilesAreNotSentAgain) {
  TestService server(withSite());
  RawClient client(server.port());
  const auto reply = client.request("GET / HTTP/1.1", {kHost, "If-None-Match: \"i1\""});
  EXPECT_EQ(reply.status, 304);
  EXPECT_TRUE(reply.body.empty());
}

TEST(Http, headHasNoBody) {
  TestService server(withSite());
  RawClient client(server.port());
  EXPECT_EQ(client.request("HEAD / HTTP/1.1", {kHost}).status, 200);
  EXPECT_EQ(client.request("GET /healthz HTTP/1.1", {kHost}).body, "alive\n");
}

TEST(Http, largeFilesArriveWhole) {
  static const std::string large(1'000'000, 'x');
  static const SiteFile files[] = {{"/big.js", "text/javascript", "\"b\"", large, {}, false}};
  TestService::Options options;
  options.configure = [](ServiceConfig& config) { config.site = files; };
  TestService server(options);
  RawClient client(server.port());
  EXPECT_EQ(client.request("GET /big.js HTTP/1.1", {kHost}).body, large);
}

TEST(Http, nothingElseIsThere) {
  TestService server(withSite());
  for (const char* path :
       {"/nothing", "/../etc/passwd", "/%2e%2e/%2e%2e/etc/passwd", "//etc/passwd", "/assets/", "/index.html/x"}) {
    RawClient client(server.port());
    EXPECT_EQ(client.request(std::string("GET ") + path + " HTTP/1.1", {kHost}).status, 404) << path;
  }
}

TEST(Http, onlyGetAndHead) {
  TestService server(withSite());
  for (const char* method : {"POST", "PUT", "DELETE", "OPTIONS", "PATCH"}) {
    RawClient client(server.port());
    EXPECT_EQ(client.request(std::string(method) + " / HTTP/1.1", {kHost}).status, 405) << method;
  }
}

TEST(Http, requestsWithBodiesAreRefused) {
  TestService server(withSite());
  for (const char* header : {"Content-Length: 5", "Content-Length: -1", "Content-Length: 99999999999999999999",
                             "Transfer-Encoding: chunked"}) {
    RawClient client(server.port());
    EXPECT_EQ(client.request("GET / HTTP/1.1", {kHost, header}).status, 400) << header;
  }
  EXPECT_EQ(RawClient(server.port()).request("GET /healthz HTTP/1.1", {kHost}).status, 200);
}

TEST(Http, foreignHostsSeeNothingButHealth) {
  TestService server(withSite());
  for (const char* path : {"/", "/metrics"}) {
    RawClient client(server.port());
    EXPECT_EQ(client.request(std::string("GET ") + path + " HTTP/1.1", {"Host: evil.example"}).status, 403);
  }
  EXPECT_EQ(RawClient(server.port()).request("GET /healthz HTTP/1.1", {"Host: 10.0.0.7"}).status, 200);
}

TEST(Http, readinessIsTold) {
  TestService::Options options;
  options.ready = false;
  TestService server(options);
  EXPECT_EQ(RawClient(server.port()).request("GET /readyz HTTP/1.1", {kHost}).status, 503);
  EXPECT_EQ(RawClient().upgrade(server.port()), 503);
  server.service->setReady(true);
  EXPECT_EQ(RawClient(server.port()).request("GET /readyz HTTP/1.1", {kHost}).status, 200);
  EXPECT_EQ(RawClient().upgrade(server.port()), 101);
}

TEST(Http, whileDrainingHealthAnswersAndUpgradesDoNot) {
  TestService server;
  TestClient stays(server.port());
  stays.greet(false);
  server.service->drain();
  stays.await<protocol::ServerBye>();   // the close is not echoed yet: the drain waits
  EXPECT_EQ(RawClient(server.port()).request("GET /readyz HTTP/1.1", {kHost}).status, 503);
  EXPECT_EQ(RawClient(server.port()).request("GET /healthz HTTP/1.1", {kHost}).status, 200);
  EXPECT_EQ(RawClient().upgrade(server.port()), 503);
}

TEST(Http, theTokenLinkBecomesACookie) {
  TestService server(withToken());
  RawClient client(server.port());
  EXPECT_EQ(client.request("GET /?token=wrong HTTP/1.1", {kHost}).status, 401);
  client.connect(server.port());
  auto reply = client.request("GET /?token=secret-7 HTTP/1.1", {kHost});
  EXPECT_EQ(reply.status, 303);
  EXPECT_EQ(reply.headers["location"], "/");
  EXPECT_EQ(reply.headers["set-cookie"], "limn-token=secret-7; HttpOnly; SameSite=Strict; Path=/");
  // Browsers keep one cookie of a name for all ports of a host.
  const std::string port = std::to_string(server.port()), named = "limn-token-" + port;
  client.connect(server.port());
  reply = client.request("GET /?token=secret-7 HTTP/1.1", {"Host: 127.0.0.1:" + port});
  EXPECT_EQ(reply.headers["set-cookie"], named + "=secret-7; HttpOnly; SameSite=Strict; Path=/");
  EXPECT_EQ(RawClient().upgrade(server.port(), {{"Cookie", "limn-token-1=secret-8; " + named + "=secret-7"}}), 101);
  EXPECT_EQ(RawClient().upgrade(server.port(), {{"Cookie", named + "=secret-8"}}), 401);
  EXPECT_EQ(RawClient().upgrade(server.port(), {{"Authorization", "Bearer secret-7"}}), 101);
  EXPECT_EQ(RawClient().upgrade(server.port(), {{"Sec-WebSocket-Protocol", "limn.v1, bearer.c2VjcmV0LTc"}}), 101);
  EXPECT_EQ(RawClient().upgrade(server.port()), 401);
  EXPECT_EQ(RawClient(server.port()).request("GET /metrics HTTP/1.1", {kHost}).status, 401);
  EXPECT_EQ(RawClient(server.port()).request("GET /metrics HTTP/1.1", {kHost, "Authorization: Bearer secret-7"}).status,
            200);
}

TEST(Http, refusedHandshakesMakeNoSession) {
  TestService server(withSite());
  const std::string port = std::to_string(server.port());
  const std::string own = "http://127.0.0.1:" + port;
  const std::vector<std::pair<std::map<std::string, std::string>, int>> cases{
      {{{"Origin", "http://evil.example"}}, 403},
      {{{"Origin", "null"}}, 403},
      {{{"Origin", own + "\r\nOrigin: http://evil.example"}}, 403},
      {{{"Origin", "http://127.0.0.1:1"}}, 403},
      {{{"Origin", "http://" + std::string(5000, 'a')}}, 400},
      {{{"Host", "evil.example"}}, 403},
      {{{"Host", "evil.example:" + port}}, 403},
      {{{"Sec-WebSocket-Protocol", ""}}, 400},
      {{{"Sec-WebSocket-Protocol", "limn.v2"}}, 400},
      {{{"Sec-WebSocket-Protocol", "chat"}}, 400},
      {{{"Sec-WebSocket-Version", "8"}}, 426},
      {{{"Sec-WebSocket-Version", ""}}, 426},
      {{{"Upgrade", "h2c"}}, 400},
      {{{"Upgrade", "h2c, websocket"}}, 403}};
  for (const auto& [headers, status] : cases)
    EXPECT_EQ(RawClient().upgrade(server.port(), headers), status)
        << headers.begin()->first << ": " << headers.begin()->second.substr(0, 60);
  EXPECT_EQ(RawClient().upgrade(server.port(), {}, "/"), 404);
  EXPECT_EQ(RawClient().upgrade(server.port(), {}, "/ws/x"), 404);
  EXPECT_EQ(server.metric("limn_sessions_total"), 0.0);
  EXPECT_EQ(server.metric("limn_upgrades_refused_total"), double(cases.size() + 1));  // the last one was refused by lws
  EXPECT_EQ(RawClient().upgrade(server.port(), {{"Origin", own}}), 101);
}

TEST(Http, keptAliveConnectionThenABadUpgrade) {
  // The order of requests that CVE-2025-11677 needs; under valgrind or a sanitizer a use after free would show.
  TestService server(withSite());
  for (const char* upgrade : {"x", "h2c", "websocketx", ""}) {
    RawClient client(server.port());
    ASSERT_EQ(client.request("GET / HTTP/1.1", {kHost, "Connection: keep-alive"}).status, 200);
    const auto reply = client.request("GET /ws HTTP/1.1",
                                      {kHost, "Connection: Upgrade", std::string("Upgrade: ") + upgrade,
                                       "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Version: 13"});
    EXPECT_TRUE(reply.status == 400 || reply.status == 403 || reply.status == 404) << upgrade << reply.status;
  }
  EXPECT_EQ(RawClient().upgrade(server.port()), 101);
}

TEST(Http, keptAliveConnectionCanBecomeASocket) {
  TestService server(withSite());
  RawClient client(server.port());
  ASSERT_EQ(client.request("GET / HTTP/1.1", {kHost, "Connection: keep-alive"}).status, 200);
  EXPECT_EQ(client.upgrade(server.port()), 101);
}

TEST(Http, metricsAreWellFormed) {
  TestService server;
  TestClient client(server.port());
  client.greet();
  client.awaitPicture([](const auto& header) { return header.flags & protocol::kFrameFinal; });
  const std::string body = RawClient(server.port()).request("GET /metrics HTTP/1.1", {kHost}).body;
  const std::regex comment("# (HELP [a-z_]+ .+|TYPE [a-z_]+ (counter|gauge))");
  const std::regex sample("[a-z_]+(\\{[a-z]+=\"[^\"\\n]*\"\\})? (-?[0-9.e+-]+|NaN|[+-]Inf)");
  std::map<std::string, int> seen;
  size_t samples = 0;
  for (size_t at = 0; at < body.size();) {
    const size_t end = body.find('\n', at);
    ASSERT_NE(end, std::string::npos) << "the last line has no end";
    const std::string line = body.substr(at, end - at);
    EXPECT_TRUE(std::regex_match(line, line[0] == '#' ? comment : sample)) << line;
    if (line[0] != '#') {
      ++samples;
      EXPECT_EQ(++seen[line.substr(0, line.find(' '))], 1) << line;
    }
    at = end + 1;
  }
  EXPECT_GT(samples, 40u);
  EXPECT_EQ(server.metric("limn_clients"), 1.0);
  EXPECT_GE(server.metric("limn_frames_sent_total"), 1.0);
  EXPECT_EQ(server.metric("limn_technique_figure{name=\"points\"}"), 262144.0);
}

TEST(Http, oneAddressHasItsOwnLimitOfConnections) {
  TestService::Options options;
  options.configure = [](ServiceConfig& config) { config.transport.maxConnectionsPerPeer = 3; };
  TestService server(options);
  std::vector<RawClient> idle;
  for (int i = 0; i < 5; ++i) {
    idle.emplace_back(server.port());
    const int status = idle.back().request("GET /healthz HTTP/1.1", {kHost, "Connection: keep-alive"}).status;
    EXPECT_EQ(status, i < 3 ? 200 : 0) << i;
  }
  idle.clear();
  server.waitForMetric("limn_connections", 1.0);
  EXPECT_GE(server.metric("limn_connections_refused_total"), 2.0);
}

TEST(Http, aHeaderThatDoesNotEndIsNotWaitedFor) {
  TestService server;
  RawClient slow(server.port());
  ASSERT_TRUE(slow.sendBytes("GET /healthz HTTP/1.1\r\nHost: loc"));
  EXPECT_NE(slow.readReply().status, 200);
  EXPECT_FALSE(slow.timedOut()) << "the server waits longer than the test";
}

TEST(Http, extensionsAreNotTakenUp) {
  TestService server;
  RawClient client(server.port());
  client.sendBytes(RawClient::handshake(
      server.port(), {{"Sec-WebSocket-Extensions", "permessage-deflate; client_max_window_bits"}}));
  const RawClient::Reply reply = client.readReply();
  EXPECT_EQ(reply.status, 101);
  EXPECT_EQ(reply.headers.count("sec-websocket-extensions"), 0u);
}

TEST(Http, moreConnectionsThanAllowedAreRefusedAtOnce) {
  TestService::Options options;
  options.configure = [](ServiceConfig& config) {
    config.transport.maxConnections = 8;
    config.transport.maxClients = 2;
  };
  TestService server(options);
  std::vector<RawClient> sockets(2);
  for (RawClient& socket : sockets) EXPECT_EQ(socket.upgrade(server.port()), 101);
  EXPECT_EQ(RawClient().upgrade(server.port()), 503);
  std::vector<RawClient> idle;
  int answered = 0, refused = 0;
  for (int i = 0; i < 12; ++i) {
    idle.emplace_back(server.port());
    const int status = idle.back().request("GET /healthz HTTP/1.1", {kHost, "Connection: keep-alive"}).status;
    (status == 200 ? answered : refused) += 1;
  }
  EXPECT_EQ(answered, 6);
  EXPECT_EQ(refused, 6);
  idle.clear();
  server.waitForMetric("limn_connections", 3.0);
}

}  // namespace
}  // namespace limn::server::testing
