#include "tests/web/http.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <utility>

namespace selfcal {

Caller::Caller(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
}

Caller::Caller(Caller&& other) noexcept : socket_(std::exchange(other.socket_, -1)) {}

Caller::~Caller() {
  if (socket_ >= 0) ::close(socket_);
}

bool Caller::send(const std::string& text) {
  return ::send(socket_, text.data(), text.size(), MSG_NOSIGNAL) ==
         static_cast<ssize_t>(text.size());
}

std::string Caller::rest(double seconds) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  std::string text;
  while (std::chrono::steady_clock::now() < end) {
    pollfd waited{socket_, POLLIN, 0};
    if (::poll(&waited, 1, 20) <= 0) continue;
    std::array<char, 65536> buffer;
    const ssize_t count = ::recv(socket_, buffer.data(), buffer.size(), 0);
    if (count <= 0) break;
    text.append(buffer.data(), static_cast<std::size_t>(count));
  }
  return text;
}

std::string ask(int port, const std::string& request) {
  Caller caller(port);
  caller.send(request);
  return caller.rest();
}

namespace {

std::string head(const std::string& first, const std::string& headers) {
  const bool named = headers.find("Host:") != std::string::npos;
  return first + " HTTP/1.1\r\n" + (named ? "" : "Host: 127.0.0.1\r\n") + headers +
         "Connection: close\r\n";
}

}  // namespace

std::string get(const std::string& path, const std::string& headers) {
  return head("GET " + path, headers) + "\r\n";
}

std::string post(const std::string& path, const std::string& body, const std::string& headers) {
  return head("POST " + path, headers) + "Content-Length: " + std::to_string(body.size()) +
         "\r\n\r\n" + body;
}

int status_of(const std::string& answer) {
  constexpr std::string_view kBegin = "HTTP/1.1 ";
  return answer.starts_with(kBegin) ? std::stoi(answer.substr(kBegin.size(), 3)) : 0;
}

std::string body_of(const std::string& answer) {
  const std::size_t at = answer.find("\r\n\r\n");
  return at == std::string::npos ? "" : answer.substr(at + 4);
}

}  // namespace selfcal
