// What std::mutex, std::shared_mutex, std::condition_variable and libatomic's locks come down to.
#include <pthread.h>
#include <semaphore.h>
#include <time.h>

#include "realtime/next_symbol.hpp"
#include "realtime/watch.hpp"

namespace {

using palpate::realtime::next_symbol;
using palpate::realtime::note;
using palpate::realtime::Offence;

// Counts, then calls what `next` keeps once it has been looked up.
template <class... Arguments>
int locked(int (*&next)(Arguments...), const char* name, Arguments... arguments) {
  note(Offence::lock);
  if (!next) next = next_symbol<int(Arguments...)>(name);
  return next(arguments...);
}

int (*next_mutex_lock)(pthread_mutex_t*) = nullptr;
int (*next_mutex_trylock)(pthread_mutex_t*) = nullptr;
int (*next_rdlock)(pthread_rwlock_t*) = nullptr;
int (*next_wrlock)(pthread_rwlock_t*) = nullptr;
int (*next_tryrdlock)(pthread_rwlock_t*) = nullptr;
int (*next_trywrlock)(pthread_rwlock_t*) = nullptr;
int (*next_spin_lock)(pthread_spinlock_t*) = nullptr;
int (*next_wait)(pthread_cond_t*, pthread_mutex_t*) = nullptr;
int (*next_timedwait)(pthread_cond_t*, pthread_mutex_t*, const timespec*) = nullptr;
int (*next_signal)(pthread_cond_t*) = nullptr;
int (*next_broadcast)(pthread_cond_t*) = nullptr;
int (*next_sem_wait)(sem_t*) = nullptr;

}  // namespace

extern "C" {

int pthread_mutex_lock(pthread_mutex_t* mutex) noexcept {
  return locked(next_mutex_lock, "pthread_mutex_lock", mutex);
}
int pthread_mutex_trylock(pthread_mutex_t* mutex) noexcept {
  return locked(next_mutex_trylock, "pthread_mutex_trylock", mutex);
}
int pthread_rwlock_rdlock(pthread_rwlock_t* lock) noexcept {
  return locked(next_rdlock, "pthread_rwlock_rdlock", lock);
}
int pthread_rwlock_wrlock(pthread_rwlock_t* lock) noexcept {
  return locked(next_wrlock, "pthread_rwlock_wrlock", lock);
}
int pthread_rwlock_tryrdlock(pthread_rwlock_t* lock) noexcept {
  return locked(next_tryrdlock, "pthread_rwlock_tryrdlock", lock);
}
int pthread_rwlock_trywrlock(pthread_rwlock_t* lock) noexcept {
  return locked(next_trywrlock, "pthread_rwlock_trywrlock", lock);
}
int pthread_spin_lock(pthread_spinlock_t* lock) noexcept {
  return locked(next_spin_lock, "pthread_spin_lock", lock);
}
int pthread_cond_wait(pthread_cond_t* condition, pthread_mutex_t* mutex) {
  return locked(next_wait, "pthread_cond_wait", condition, mutex);
}
int pthread_cond_timedwait(pthread_cond_t* condition, pthread_mutex_t* mutex,
                           const timespec* deadline) {
  return locked(next_timedwait, "pthread_cond_timedwait", condition, mutex, deadline);
}
int pthread_cond_signal(pthread_cond_t* condition) noexcept {
  return locked(next_signal, "pthread_cond_signal", condition);
}
int pthread_cond_broadcast(pthread_cond_t* condition) noexcept {
  return locked(next_broadcast, "pthread_cond_broadcast", condition);
}
int sem_wait(sem_t* semaphore) {
  return locked(next_sem_wait, "sem_wait", semaphore);
}

}  // extern "C"
