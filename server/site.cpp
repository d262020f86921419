#include "server/site.hpp"

#include <algorithm>

namespace limn::server {

HttpReply serveSite(std::span<const SiteFile> site, const HttpRequest& request) {
  const std::string_view path = request.headers.path == "/" ? std::string_view("/index.html") : request.headers.path;
  const auto found = std::find_if(site.begin(), site.end(), [&](const SiteFile& file) { return file.path == path; });
  HttpReply reply;
  if (found == site.end()) {
    reply.status = 404;
    reply.text = "nothing is here\n";
    return reply;
  }
  reply.mime = found->mime;
  reply.headers.emplace_back("etag:", found->etag);
  reply.headers.emplace_back("cache-control:", found->immutable ? "public, max-age=31536000, immutable" : "no-cache");
  reply.headers.emplace_back("vary:", "accept-encoding");
  if (request.ifNoneMatch == found->etag) {
    reply.status = 304;
  } else if (request.acceptsGzip && !found->gzip.empty()) {
    reply.headers.emplace_back("content-encoding:", "gzip");
    reply.fixed = found->gzip;
  } else {
    reply.fixed = found->bytes;
  }
  return reply;
}

}  // namespace limn::server
