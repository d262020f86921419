#include "server/access.hpp"

#include <gtest/gtest.h>

namespace limn::server {
namespace {

AccessPolicy loopback() {
  AccessPolicy policy;
  policy.listenHost = "127.0.0.1";
  return policy;
}

RequestHeaders good() {
  RequestHeaders headers;
  headers.path = "/ws";
  headers.host = "127.0.0.1:8080";
  headers.upgrade = "websocket";
  headers.subprotocols = "limn.v1";
  headers.version = "13";
  return headers;
}

int statusWithOrigin(const AccessPolicy& policy, const std::string& origin,
                     const std::string& host = "127.0.0.1:8080") {
  RequestHeaders headers = good();
  headers.host = host;
  headers.hasOrigin = true;
  headers.origin = origin;
  return judgeUpgrade(policy, headers).status;
}

TEST(Access, nativeClientWithoutOriginIsAllowed) { EXPECT_TRUE(judgeUpgrade(loopback(), good()).allowed()); }

TEST(Access, originMatrix) {
  const AccessPolicy policy = loopback();
  EXPECT_EQ(statusWithOrigin(policy, "http://127.0.0.1:8080"), 200);
  EXPECT_EQ(statusWithOrigin(policy, "HTTP://127.0.0.1:8080"), 200);
  EXPECT_EQ(statusWithOrigin(policy, "https://127.0.0.1:8080"), 200);
  EXPECT_EQ(statusWithOrigin(policy, "http://localhost:8080", "localhost:8080"), 200);
  for (const char* origin :
       {"null", "", "http://evil.example", "http://127.0.0.1:8081", "http://127.0.0.1", "http://localhost:8080",
        "http://127.0.0.1:8080.evil.example", "http://evil.127.0.0.1:8080", "http://*",
        "http://127.0.0.1:8080,http://evil.example", "http://127.0.0.1:8080/", "http://user@127.0.0.1:8080",
        "file://127.0.0.1:8080", "127.0.0.1:8080"})
    EXPECT_EQ(statusWithOrigin(policy, origin), 403) << origin;
}

TEST(Access, allowedOriginIsComparedWhole) {
  AccessPolicy policy = loopback();
  policy.allowedOrigins = {"https://viewer.example:8443"};
  EXPECT_EQ(statusWithOrigin(policy, "https://viewer.example:8443"), 200);
  EXPECT_EQ(statusWithOrigin(policy, "https://viewer.example:8443", "viewer.example:8443"), 200);
  EXPECT_EQ(statusWithOrigin(policy, "https://viewer.example"), 403);
  EXPECT_EQ(statusWithOrigin(policy, "http://viewer.example:8443"), 403);
  EXPECT_EQ(statusWithOrigin(policy, "https://a.viewer.example:8443"), 403);
}

TEST(Access, hostMatrixOfALoopbackListener) {
  for (const char* host : {"127.0.0.1", "127.0.0.1:9", "127.1.2.3:80", "localhost", "LOCALHOST:8080", "[::1]:8080"}) {
    RequestHeaders headers = good();
    headers.host = host;
    EXPECT_TRUE(judgeHost(loopback(), headers).allowed()) << host;
  }
  for (const char* host : {"evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example",
                           "10.0.0.1:8080", "127.", "127.0.0.1x", "[::2]:8080", "[fe80::1"}) {
    RequestHeaders headers = good();
    headers.host = host;
    EXPECT_EQ(judgeHost(loopback(), headers).status, 403) << host;
  }
  RequestHeaders headers = good();
  headers.host.clear();
  EXPECT_EQ(judgeHost(loopback(), headers).status, 400);
}

TEST(Access, hostMatrixOfAPublicListener) {
  AccessPolicy policy = loopback();
  policy.listenHost = "0.0.0.0";
  policy.allowedOrigins = {"https://viewer.example"};
  const auto statusOf = [&](const char* host) {
    RequestHeaders headers = good();
    headers.host = host;
    return judgeHost(policy, headers).status;
  };
  EXPECT_EQ(statusOf("192.168.1.7:8080"), 200);
  EXPECT_EQ(statusOf("[2001:db8::1]:8080"), 200);
  EXPECT_EQ(statusOf("viewer.example:8080"), 200);
  EXPECT_EQ(statusOf("evil.example"), 403);
}

TEST(Access, eachHandshakeHeaderIsNeeded) {
  const auto statusAfter = [](auto change) {
    RequestHeaders headers = good();
    change(headers);
    return judgeUpgrade(loopback(), headers).status;
  };
  EXPECT_EQ(statusAfter([](auto& h) { h.path = "/"; }), 404);
  EXPECT_EQ(statusAfter([](auto& h) { h.path = "/ws/"; }), 404);
  EXPECT_EQ(statusAfter([](auto& h) { h.upgrade = "h2c"; }), 400);
  EXPECT_EQ(statusAfter([](auto& h) { h.upgrade = "WebSocket"; }), 200);
  EXPECT_EQ(statusAfter([](auto& h) { h.version = "8"; }), 426);
  EXPECT_EQ(statusAfter([](auto& h) { h.version.clear(); }), 426);
  EXPECT_EQ(statusAfter([](auto& h) { h.subprotocols.clear(); }), 400);
  EXPECT_EQ(statusAfter([](auto& h) { h.subprotocols = "limn.v2"; }), 400);
  EXPECT_EQ(statusAfter([](auto& h) { h.subprotocols = "limn.v1x"; }), 400);
  EXPECT_EQ(statusAfter([](auto& h) { h.subprotocols = "chat, limn.v1"; }), 200);
  EXPECT_EQ(statusAfter([](auto& h) { h.hasBody = true; }), 400);
  EXPECT_EQ(statusAfter([](auto& h) { h.oversized = true; }), 400);
}

TEST(Access, tokenMatrix) {
  AccessPolicy policy = loopback();
  policy.token = "secret-7";
  const auto statusAfter = [&](auto change) {
    RequestHeaders headers = good();
    change(headers);
    return judgeUpgrade(policy, headers).status;
  };
  EXPECT_EQ(statusAfter([](auto&) {}), 401);
  EXPECT_EQ(statusAfter([](auto& h) { h.authorization = "Bearer secret-7"; }), 200);
  EXPECT_EQ(statusAfter([](auto& h) { h.authorization = "bearer secret-7"; }), 200);
  EXPECT_EQ(statusAfter([](auto& h) { h.authorization = "Bearer secret-8"; }), 401);
  EXPECT_EQ(statusAfter([](auto& h) { h.authorization = "Bearer secret-7x"; }), 401);
  EXPECT_EQ(statusAfter([](auto& h) { h.authorization = "Bearer secret-7secret-7"; }), 401);
  EXPECT_EQ(statusAfter([](auto& h) { h.authorization = "Bearer "; }), 401);
  EXPECT_EQ(statusAfter([](auto& h) { h.authorization = "Basic secret-7"; }), 401);
  EXPECT_EQ(statusAfter([](auto& h) { h.cookie = "a=b; limn-token-8080=secret-7"; }), 200);
  EXPECT_EQ(statusAfter([](auto& h) { h.cookie = "limn-token-8080=wrong"; }), 401);
  EXPECT_EQ(statusAfter([](auto& h) { h.cookie = "xlimn-token-8080=secret-7"; }), 401);
  EXPECT_EQ(statusAfter([](auto& h) { h.subprotocols = "limn.v1, bearer.c2VjcmV0LTc"; }), 200);
  EXPECT_EQ(statusAfter([](auto& h) { h.subprotocols = "limn.v1, bearer.c2VjcmV0LTg"; }), 401);
  EXPECT_EQ(statusAfter([](auto& h) { h.subprotocols = "limn.v1, bearer.!!"; }), 401);
}

TEST(Access, basePathMovesTheSocket) {
  AccessPolicy policy = loopback();
  policy.basePath = "/s/7";
  RequestHeaders headers = good();
  EXPECT_EQ(judgeUpgrade(policy, headers).status, 404);
  headers.path = "/s/7/ws";
  EXPECT_EQ(judgeUpgrade(policy, headers).status, 200);
}

TEST(Access, hostsLoseTheirPorts) {
  EXPECT_EQ(hostWithoutPort("a.example:80"), "a.example");
  EXPECT_EQ(hostWithoutPort("a.example"), "a.example");
  EXPECT_EQ(hostWithoutPort("[::1]:80"), "[::1]");
  EXPECT_EQ(hostWithoutPort("::1"), "::1");
}

}  // namespace
}  // namespace limn::server
