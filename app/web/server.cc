// cpp-httplib parses, routes and writes; how long a connection may take, how much it may send and
// how many there may be is ours: the library's own limits are between two bytes, and one that sends
// a byte a second would hold a thread for hours.
#include "app/web/server.h"

#include <httplib.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <condition_variable>
#include <cstring>
#include <list>
#include <mutex>
#include <thread>

#include "app/web/connections.h"

namespace selfcal {
namespace {

using WebClock = Connections::Clock;

constexpr std::size_t kRequests = 1'000'000;  // of one connection
constexpr int kLine = 128;                    // of connections not yet taken

WebClock::time_point in_seconds(double seconds) {
  return WebClock::now() +
         std::chrono::duration_cast<WebClock::duration>(std::chrono::duration<double>(seconds));
}

/// A connection with a deadline for each request and each response.
class TimedStream final : public httplib::Stream {
 public:
  TimedStream(int socket, Connections::Slot& slot, const ServerLimits& limits)
      : socket_(socket), slot_(slot), limits_(limits) {
    std::array<char, NI_MAXHOST> host{};
    sockaddr_storage peer{};
    socklen_t size = sizeof peer;
    if (::getpeername(socket, reinterpret_cast<sockaddr*>(&peer), &size) == 0 &&
        ::getnameinfo(reinterpret_cast<sockaddr*>(&peer), size, host.data(), host.size(), nullptr,
                      0, NI_NUMERICHOST) == 0)
      peer_ = host.data();
  }

  /// Waits for a request's first byte; false when the peer has gone or the time is over.
  bool begins(double longest) {
    slot_.waits();
    left_ = limits_.request;
    if (from_ == to_ && !wait_for(POLLIN, in_seconds(longest))) return false;
    read_end_ = in_seconds(limits_.request_seconds);
    write_end_.reset();
    return true;
  }

  bool is_readable() const override { return from_ < to_ || left_ > 0; }
  bool is_writable() const override { return true; }

  ssize_t read(char* to, std::size_t size) override {
    if (from_ == to_) {
      if (left_ == 0 || !wait_for(POLLIN, read_end_)) return -1;
      const ssize_t count = ::recv(socket_, buffer_.data(), std::min(buffer_.size(), left_), 0);
      if (count <= 0) return count;
      from_ = 0;
      to_ = static_cast<std::size_t>(count);
      left_ -= to_;
    }
    const std::size_t count = std::min(size, to_ - from_);
    std::memcpy(to, buffer_.data() + from_, count);
    from_ += count;
    return static_cast<ssize_t>(count);
  }

  ssize_t write(const char* from, std::size_t size) override {
    if (!write_end_) {
      write_end_ = in_seconds(limits_.response_seconds);
      slot_.waits();
    }
    if (!wait_for(POLLOUT, *write_end_)) return -1;
    return ::send(socket_, from, size, MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  void get_remote_ip_and_port(std::string& ip, int& port) const override {
    ip = peer_;
    port = 0;  // nobody asks for it
  }
  void get_local_ip_and_port(std::string& ip, int& port) const override {
    ip.clear();
    port = 0;
  }
  socket_t socket() const override { return socket_; }

 private:
  bool wait_for(short event, WebClock::time_point end) const {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - WebClock::now()).count();
    pollfd waited{socket_, event, 0};
    return left > 0 && ::poll(&waited, 1, static_cast<int>(left)) > 0;
  }

  int socket_;
  Connections::Slot& slot_;
  const ServerLimits& limits_;
  std::string peer_;
  std::array<char, 4096> buffer_{};
  std::size_t from_ = 0, to_ = 0;  // of the buffer, not yet read
  std::size_t left_ = 0;           // bytes that this request may still have
  WebClock::time_point read_end_;
  std::optional<WebClock::time_point> write_end_;  // of the response, once it has begun
};

/// Threads that take connections one by one; what comes when all have one waits in a short line.
class Crew final : public httplib::TaskQueue {
 public:
  Crew(int threads, Connections& connections) : connections_(connections) {
    for (int i = 0; i < threads; ++i) threads_.emplace_back([this] { work(); });
  }

  void enqueue(std::function<void()> task) override {
    std::unique_lock lock(mutex_);
    line_.push_back(std::move(task));
    changed_.notify_one();
    // Nobody comes in for a moment where all are at work in earnest.
    for (int i = 0; i < kPatience && !ended_ && line_.size() > idle_; ++i) {
      connections_.push_one_out();
      shorter_.wait_for(lock, std::chrono::milliseconds(10));
    }
  }

  void shutdown() override {
    {
      const std::lock_guard lock(mutex_);
      ended_ = true;
    }
    changed_.notify_all();
    for (std::thread& each : threads_) each.join();
  }

 private:
  void work() {
    std::unique_lock lock(mutex_);
    while (true) {
      ++idle_;
      changed_.wait(lock, [&] { return ended_ || !line_.empty(); });
      --idle_;
      if (line_.empty()) return;
      const auto task = std::move(line_.front());
      line_.pop_front();
      if (line_.size() > idle_) connections_.push_one_out();
      shorter_.notify_one();
      lock.unlock();
      task();
      lock.lock();
    }
  }

  static constexpr int kPatience = 10;

  Connections& connections_;
  std::mutex mutex_;
  std::condition_variable changed_, shorter_;
  std::list<std::function<void()>> line_;
  std::size_t idle_ = 0;
  bool ended_ = false;
  std::vector<std::thread> threads_;
};

RequestHead head_of(const httplib::Request& request) {
  const auto header = [&](const char* name) { return request.get_header_value(name); };
  return {.method = request.method,
          .path = request.path,
          .target_bytes = request.target.size(),
          .host = header("Host"),
          .origin = header("Origin"),
          .site = header("Sec-Fetch-Site"),
          .authorization = header("Authorization"),
          .command = header(kCommandHeader)};
}

void answer_with(httplib::Response& response, const WebResponse& answer) {
  response.status = answer.status;
  response.set_content(answer.body, answer.type);
}

class HttpServer final : public WebServer, private httplib::Server {
 public:
  HttpServer(WebAddress address, GateRules rules, const ServerLimits& limits, WebHandler handler)
      : web_address_(std::move(address)),
        rules_(std::move(rules)),
        limits_(limits),
        handler_(std::move(handler)) {
    new_task_queue = [this] { return new Crew(limits_.connections, connections_); };
    set_payload_max_length(limits_.body);
    set_tcp_nodelay(true);
    // The library's own would let a second server share the port.
    set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    set_keep_alive_timeout(static_cast<time_t>(limits_.idle_seconds));
    set_keep_alive_max_count(kRequests);
    set_default_headers({{"Cache-Control", "no-store"},
                         {"X-Content-Type-Options", "nosniff"},
                         {"X-Frame-Options", "DENY"},
                         {"Referrer-Policy", "no-referrer"},
                         {"Cross-Origin-Resource-Policy", "same-origin"},
                         {"Cross-Origin-Opener-Policy", "same-origin"}});
    // Before the body is read and before any pattern is matched.
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      const auto refusal = refused(head_of(request), rules_);
      if (!refusal) return HandlerResponse::Unhandled;
      answer_with(response, {refusal->status, "text/plain", refusal->why + "\n"});
      return HandlerResponse::Handled;
    });
    const auto answer = [this](const httplib::Request& request, httplib::Response& response) {
      WebRequest got{request.path, {}, request.body, request.remote_addr};
      for (const auto& [name, value] : request.params) got.query[name] = value;
      answer_with(response, handler_(got));
    };
    Get("/(?:state)?", answer);
    Post(kCommandPath, answer);
  }

  ~HttpServer() override {
    stopping_ = true;
    stop();
    connections_.cut_off();
    if (listening_.joinable()) listening_.join();
  }

  bool listen_now() {
    if (web_address_.port == 0)
      web_address_.port = bind_to_any_port(web_address_.host);
    else if (!bind_to_port(web_address_.host, web_address_.port))
      return false;
    // The library's own line of 5 has browsers that open several at once try again after a second.
    if (web_address_.port <= 0 || ::listen(svr_sock_, kLine) != 0) return false;
    // A server that is stopped before it runs would run forever.
    listening_ = std::thread([this] { listen_after_bind(); });
    while (!is_running()) std::this_thread::yield();
    return true;
  }

  const WebAddress& address() const override { return web_address_; }

 private:
  // Of httplib::Server; the body of every thread of the crew.
  bool process_and_close_socket(socket_t socket) override {
    {
      Connections::Slot slot = connections_.enter(socket);
      TimedStream stream(socket, slot, limits_);
      bool more = true, closed = false;
      double wait = limits_.request_seconds;
      for (std::size_t i = 0; i < kRequests && more && !closed && !stopping_; ++i) {
        if (!stream.begins(wait)) break;
        wait = limits_.idle_seconds;
        more = process_request(stream, false, closed, [&](httplib::Request& request) {
          slot.works();
          request.headers.erase("Range");
          // Of a refused command the body is not read, and must not be taken for a request.
          if (request.method == "POST") closed = true;
        });
      }
    }
    ::shutdown(socket, SHUT_RDWR);
    return ::close(socket) == 0;
  }

  WebAddress web_address_;
  GateRules rules_;
  ServerLimits limits_;
  WebHandler handler_;
  Connections connections_;
  std::atomic<bool> stopping_ = false;
  std::thread listening_;
};

}  // namespace

Result<std::unique_ptr<WebServer>> WebServer::open(const WebAddress& address, GateRules rules,
                                                   const ServerLimits& limits, WebHandler handler) {
  auto server = std::make_unique<HttpServer>(address, std::move(rules), limits, std::move(handler));
  if (!server->listen_now())
    return device_failed("--web: " + address.url() +
                         " cannot be served: the address is not this computer's or taken");
  return server;
}

}  // namespace selfcal
