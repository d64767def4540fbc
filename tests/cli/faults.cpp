// Preloaded before a program, this refuses it what DUO_FAULTS says, and writes into the file DUO_FAULTS_LOG to whom it connects
// and what it binds.
//
// DUO_FAULTS  "memory=7 files=3+": of main()'s calls the seventh allocation of a kB or more fails, and the third opened file
// and all
//             after it.
//             There are memory (ENOMEM), files (EMFILE), threads (EAGAIN), writes (ENOSPC), syncs (EIO), names (EIO: renames),
//             exchanges (EINVAL: a file system that lacks renameat2's flags).
#include <arpa/inet.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <pthread.h>
#include <stdarg.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>

extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
}

namespace {

/// One kind of call that fails at a number.
class Fault {
 public:
  constexpr explicit Fault(const char* name) : name_(name) {}
  bool strikes() {
    if (first_ == kUnread) read();
    if (first_ == 0) return false;
    const long call = ++calls_;
    return call == first_ || (ever_ && call > first_);
  }

 private:
  static constexpr long kUnread = -1;
  void read() {
    const char* all = std::getenv("DUO_FAULTS");
    const char* at = all != nullptr ? std::strstr(all, name_) : nullptr;
    if (at == nullptr) {
      first_ = 0;
      return;
    }
    char* end = nullptr;
    const long first = std::strtol(at + std::strlen(name_) + 1, &end, 10);
    ever_ = *end == '+';
    first_ = first;
  }
  const char* name_;
  std::atomic<long> first_{kUnread}, calls_{0};
  bool ever_ = false;
};

Fault memory("memory"), files("files"), threads("threads"), writes("writes"), syncs("syncs"), names("names"),
    exchanges("exchanges");

std::atomic<bool> started = false;  // before main() runs, what other libraries ask for is theirs

bool refused(Fault& fault, int error) {
  if (!started || !fault.strikes()) return false;
  errno = error;
  return true;
}

bool no_memory(size_t bytes) {
  constexpr size_t kLeast = 1024;
  return bytes >= kLeast && refused(memory, ENOMEM);
}

void note(const char* what, const sockaddr* address) {
  const char* path = std::getenv("DUO_FAULTS_LOG");
  if (path == nullptr || address == nullptr || (address->sa_family != AF_INET && address->sa_family != AF_INET6)) return;
  char host[64] = {}, line[128];
  const auto* four = reinterpret_cast<const sockaddr_in*>(address);
  const auto* six = reinterpret_cast<const sockaddr_in6*>(address);
  const bool is_four = address->sa_family == AF_INET;
  inet_ntop(address->sa_family, is_four ? static_cast<const void*>(&four->sin_addr) : &six->sin6_addr, host, sizeof host);
  const int size = std::snprintf(line, sizeof line, "%s %s:%d\n", what, host, ntohs(is_four ? four->sin_port : six->sin6_port));
  const auto log = static_cast<int>(syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND, 0666));
  if (syscall(SYS_write, log, line, size) < 0) std::abort();
  syscall(SYS_close, log);
}

int open_at(int folder, const char* path, int flags, va_list arguments) {
  const int mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, int) : 0;
  if (refused(files, EMFILE)) return -1;
  return static_cast<int>(syscall(SYS_openat, folder, path, flags, mode));
}

template <class Function>
Function next(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

using Main = int (*)(int, char**, char**);
Main program = nullptr;

int started_program(int argc, char** argv, char** environment) {
  started = true;
  return program(argc, argv, environment);
}

}  // namespace

extern "C" {

int __libc_start_main(Main main, int argc, char** argv, void (*begin)(), void (*end)(), void (*unload)(), void* stack) {
  program = main;
  return next<int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*)>("__libc_start_main")(
      started_program, argc, argv, begin, end, unload, stack);
}

void* malloc(size_t bytes) { return no_memory(bytes) ? nullptr : __libc_malloc(bytes); }
void* calloc(size_t count, size_t bytes) { return no_memory(count * bytes) ? nullptr : __libc_calloc(count, bytes); }
void* realloc(void* p, size_t bytes) { return no_memory(bytes) ? nullptr : __libc_realloc(p, bytes); }
void* aligned_alloc(size_t align, size_t bytes) { return no_memory(bytes) ? nullptr : __libc_memalign(align, bytes); }
void* memalign(size_t align, size_t bytes) { return no_memory(bytes) ? nullptr : __libc_memalign(align, bytes); }
int posix_memalign(void** p, size_t align, size_t bytes) {
  void* made = no_memory(bytes) ? nullptr : __libc_memalign(align, bytes);
  if (made == nullptr) return ENOMEM;
  *p = made;
  return 0;
}

int open(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int fd = open_at(AT_FDCWD, path, flags, arguments);
  va_end(arguments);
  return fd;
}
int open64(const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int fd = open_at(AT_FDCWD, path, flags, arguments);
  va_end(arguments);
  return fd;
}
int openat(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int fd = open_at(folder, path, flags, arguments);
  va_end(arguments);
  return fd;
}
int openat64(int folder, const char* path, int flags, ...) {
  va_list arguments;
  va_start(arguments, flags);
  const int fd = open_at(folder, path, flags, arguments);
  va_end(arguments);
  return fd;
}
int socket(int domain, int type, int protocol) {
  return refused(files, EMFILE) ? -1 : static_cast<int>(syscall(SYS_socket, domain, type, protocol));
}

ssize_t write(int fd, const void* bytes, size_t size) {
  return fd > 2 && refused(writes, ENOSPC) ? -1 : syscall(SYS_write, fd, bytes, size);
}
ssize_t pwrite(int fd, const void* bytes, size_t size, off_t at) {
  return refused(writes, ENOSPC) ? -1 : syscall(SYS_pwrite64, fd, bytes, size, at);
}
ssize_t pwrite64(int fd, const void* bytes, size_t size, off_t at) { return pwrite(fd, bytes, size, at); }
int fallocate(int fd, int mode, off_t from, off_t size) {
  return refused(writes, ENOSPC) ? -1 : static_cast<int>(syscall(SYS_fallocate, fd, mode, from, size));
}
int fallocate64(int fd, int mode, off_t from, off_t size) { return fallocate(fd, mode, from, size); }
int fsync(int fd) { return refused(syncs, EIO) ? -1 : static_cast<int>(syscall(SYS_fsync, fd)); }
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  return refused(names, EIO) ? -1 : static_cast<int>(syscall(SYS_renameat, from_folder, from, to_folder, to));
}
int renameat2(int from_folder, const char* from, int to_folder, const char* to, unsigned flags) {
  if ((flags != 0 && refused(exchanges, EINVAL)) || refused(names, EIO)) return -1;
  return static_cast<int>(syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*run)(void*), void* argument) {
  if (started && threads.strikes()) return EAGAIN;
  return next<int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*)>("pthread_create")(thread, attributes, run,
                                                                                                     argument);
}

int connect(int fd, const sockaddr* address, socklen_t size) {
  note("connect", address);
  return static_cast<int>(syscall(SYS_connect, fd, address, size));
}
int bind(int fd, const sockaddr* address, socklen_t size) {
  note("bind", address);
  return static_cast<int>(syscall(SYS_bind, fd, address, size));
}
ssize_t sendto(int fd, const void* bytes, size_t size, int flags, const sockaddr* address, socklen_t address_size) {
  note("send", address);
  return syscall(SYS_sendto, fd, bytes, size, flags, address, address_size);
}

}  // extern "C"
