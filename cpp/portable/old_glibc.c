/* Replacements for functions of glibc after 2.28 that GCC 12's libstdc++.a and the libraries use. They have hidden visibility:
 * the module prefers them to the C library's, and no other module sees them. */
#define _GNU_SOURCE
#include <errno.h>
#include <pthread.h>
#include <stdint.h>
#include <sys/random.h>
#include <time.h>

#pragma GCC visibility push(hidden)

/* glibc 2.32: "this process has one thread only", which lets shared pointers count without atomics. */
char __libc_single_threaded = 0;

/* glibc 2.36. */
uint32_t arc4random(void) {
  uint32_t value;
  while (getrandom(&value, sizeof value, 0) != (ssize_t)sizeof value) {
  }
  return value;
}

/* Converts a time of another clock to CLOCK_REALTIME. */
static struct timespec on_wall_clock(clockid_t clock, const struct timespec* moment) {
  struct timespec now, wall;
  clock_gettime(clock, &now);
  clock_gettime(CLOCK_REALTIME, &wall);
  int64_t nanoseconds = (int64_t)(moment->tv_nsec - now.tv_nsec) + wall.tv_nsec;
  wall.tv_sec += moment->tv_sec - now.tv_sec;
  wall.tv_sec += nanoseconds / 1000000000;
  wall.tv_nsec = nanoseconds % 1000000000;
  if (wall.tv_nsec < 0) {
    wall.tv_nsec += 1000000000;
    wall.tv_sec -= 1;
  }
  return wall;
}

/* glibc 2.30: used by std::timed_mutex and std::condition_variable to wait on the steady clock. */
int pthread_mutex_clocklock(pthread_mutex_t* mutex, clockid_t clock, const struct timespec* moment) {
  struct timespec wall = clock == CLOCK_REALTIME ? *moment : on_wall_clock(clock, moment);
  return pthread_mutex_timedlock(mutex, &wall);
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t clock,
                           const struct timespec* moment) {
  struct timespec wall = clock == CLOCK_REALTIME ? *moment : on_wall_clock(clock, moment);
  return pthread_cond_timedwait(condition, mutex, &wall);
}

/* glibc 2.29 gave these a second version, which differs in errno only. */
#define FIRST_VERSION(name, parameters, arguments)                                                                     \
  __attribute__((visibility("default"))) double first_##name parameters;                                               \
  __asm__(".symver first_" #name "," #name "@GLIBC_2.2.5");                                                            \
  double name parameters { return first_##name arguments; }

FIRST_VERSION(exp, (double x), (x))
FIRST_VERSION(exp2, (double x), (x))
FIRST_VERSION(log, (double x), (x))
FIRST_VERSION(log2, (double x), (x))
FIRST_VERSION(pow, (double x, double y), (x, y))

#pragma GCC visibility pop
