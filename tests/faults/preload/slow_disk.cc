// A slow disk: loaded before a process (LD_PRELOAD), it makes every synchronisation of a file take
// SLOW_DISK_MS longer.
#include <dlfcn.h>
#include <unistd.h>

#include <cstdlib>

namespace {

using Sync = int (*)(int);

int slowly(const char* name, int file) {
  static const int delay_ms = [] {
    const char* text = std::getenv("SLOW_DISK_MS");
    return text ? std::atoi(text) : 10;
  }();
  usleep(1000 * static_cast<useconds_t>(delay_ms));
  const auto real = reinterpret_cast<Sync>(dlsym(RTLD_NEXT, name));
  return real ? real(file) : -1;
}

}  // namespace

extern "C" int fsync(int file) { return slowly("fsync", file); }
extern "C" int fdatasync(int file) { return slowly("fdatasync", file); }
