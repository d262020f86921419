#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace limn::server {

/// Name of the cookie that holds the token, for the Host that a browser asked: browsers keep cookies by host and path
/// alone, so servers on two ports of one host need two names.
std::string tokenCookieFor(std::string_view host);

/// Who may speak to the daemon. Set once, before the loop runs.
struct AccessPolicy {
  std::string basePath;                     ///< "" or "/prefix", without a slash at the end
  std::string listenHost;                   ///< the address listened on, as given
  std::vector<std::string> allowedOrigins;  ///< whole origins: "https://viewer.example:8443"
  std::string token;                        ///< empty: none is asked for

  std::string socketPath() const { return basePath + "/ws"; }
};

/// The headers that decide about a request. Absent ones are empty.
struct RequestHeaders {
  std::string path, host, origin, authorization, cookie;
  std::string upgrade, subprotocols, version;  ///< Upgrade, Sec-WebSocket-Protocol, Sec-WebSocket-Version
  bool hasOrigin = false;                      ///< an empty Origin is not an absent one
  bool hasBody = false;                        ///< Content-Length or Transfer-Encoding is there
  bool oversized = false;                      ///< a header above is longer than is looked at
};

/// `status` 200: allowed; otherwise the HTTP status to answer with and one sentence why.
struct Verdict {
  int status = 200;
  std::string reason;
  bool allowed() const { return status == 200; }
};

/// A WebSocket upgrade: path, Upgrade, version, subprotocol, Host, Origin, token; all before any state is made.
Verdict judgeUpgrade(const AccessPolicy& policy, const RequestHeaders& headers);
/// Host against DNS rebinding: a loopback listener answers to loopback names alone; any other also to IP literals,
/// which cannot be rebound, to the address it listens on and to the hosts of the allowed origins.
Verdict judgeHost(const AccessPolicy& policy, const RequestHeaders& headers);
/// Token in `Authorization: Bearer`, in the cookie, or as subprotocol `bearer.<base64url>`. Compared in constant time.
bool tokenMatches(const AccessPolicy& policy, const RequestHeaders& headers);

/// True for equal texts; the time depends on the length of `given` alone.
bool equalInConstantTime(std::string_view expected, std::string_view given);
bool isLoopbackName(std::string_view host);  ///< "127.x.y.z", "localhost", "[::1]" or "::1"
bool isIpLiteral(std::string_view host);     ///< IPv4, or IPv6 with or without brackets
std::string_view hostWithoutPort(std::string_view authority);

}  // namespace limn::server
