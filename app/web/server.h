// A small HTTP server for one page and what it asks: bounded in connections, time and bytes. The
// library behind it is seen in server.cc alone.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "app/web/address.h"
#include "app/web/gate.h"

namespace selfcal {

struct WebRequest {
  std::string path;
  std::map<std::string, std::string> query;
  std::string body;  ///< at most ServerLimits::body bytes
  std::string peer;  ///< address of who asks
};

struct WebResponse {
  int status = 200;
  std::string type = "application/json";
  std::string body = {};
};

struct ServerLimits {
  int connections = 32;          ///< at a time, each with a thread; 1 to 1000
  std::size_t body = 1024;       ///< bytes of a request's body
  std::size_t request = 16384;   ///< bytes of a whole request
  double request_seconds = 5;    ///< from a request's first byte to its last
  double idle_seconds = 15;      ///< between the requests of a connection
  double response_seconds = 60;  ///< until the peer has taken the response
};

/// Answers requests that the gate lets pass; called from many threads at a time.
using WebHandler = std::function<WebResponse(const WebRequest&)>;

class WebServer {
 public:
  /// Serves from now on. Fails when the address cannot be had (kDeviceFailed).
  static Result<std::unique_ptr<WebServer>> open(const WebAddress& address, GateRules rules,
                                                 const ServerLimits& limits, WebHandler handler);
  /// Cuts off every connection and waits for handlers that are at work.
  virtual ~WebServer() = default;

  /// With the port that was free.
  virtual const WebAddress& address() const = 0;
};

}  // namespace selfcal
