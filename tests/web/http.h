// A client of plain sockets, which may be as slow and as rude as a test wants.
#pragma once

#include <string>

namespace selfcal {

/// A connection to 127.0.0.1, closed with this.
class Caller {
 public:
  explicit Caller(int port);
  Caller(Caller&& other) noexcept;
  Caller& operator=(Caller&&) = delete;
  ~Caller();

  /// False when the server has closed.
  bool send(const std::string& text);
  /// All until the server closes, or `seconds` have passed.
  std::string rest(double seconds = 10);

 private:
  int socket_;
};

/// Sends the request and returns the whole answer.
std::string ask(int port, const std::string& request);

/// "GET PATH" with these header lines, each ended by \r\n; Host is ours unless they name one.
std::string get(const std::string& path, const std::string& headers = {});
std::string post(const std::string& path, const std::string& body, const std::string& headers = {});

/// 0 where there is none.
int status_of(const std::string& answer);
std::string body_of(const std::string& answer);

}  // namespace selfcal
