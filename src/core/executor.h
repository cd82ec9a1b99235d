#pragma once
/// \file
/// The one parallel loop. Work is cut into chunks whose bounds do not depend on the number of
/// threads, so a loop whose chunks are independent gives the same bits however many there are.

#include <memory>
#include <type_traits>

namespace percale {

class Executor {
 public:
  /// `threads` >= 1, or 0 for the number of cores.
  explicit Executor(int threads = 0);
  ~Executor();
  Executor(const Executor&) = delete;
  Executor& operator=(const Executor&) = delete;

  int threads() const { return threads_; }

  /// Calls body(chunk) once for every chunk in 0..chunks-1, in any order and on any thread, and
  /// returns when all are done. Serial, in order, with one thread or one chunk. Does not allocate
  /// with one thread.
  template <class Body>
  void ForChunks(int chunks, Body&& body) const {
    if (threads_ == 1 || chunks <= 1) {
      for (int chunk = 0; chunk < chunks; ++chunk) body(chunk);
      return;
    }
    Run(
        chunks, [](void* context, int chunk) { (*static_cast<std::remove_reference_t<Body>*>(context))(chunk); },
        const_cast<void*>(static_cast<const void*>(&body)));
  }

 private:
  using ChunkFunction = void (*)(void* context, int chunk);
  void Run(int chunks, ChunkFunction function, void* context) const;

  struct Backend;
  std::unique_ptr<Backend> backend_;
  int threads_;
};

}  // namespace percale
