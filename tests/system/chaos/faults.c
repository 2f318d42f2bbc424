/* Faults of a machine for one process, by LD_PRELOAD: a clock that jumps, and file locks that a server loses.
 *
 * CHAOS_CLOCK=SECONDS is added to the time of day for 5 s of every 10 s. CHAOS_LOCKS=N makes one of N requests
 * for a lock fail (ENOLCK), and all requests for locks of files named *.lock succeed without a lock.
 */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

static long number(const char *name) {
  const char *text = getenv(name);
  return text ? atol(text) : 0;
}

/* Sets *function to the function that this library replaces. */
static void find(void *function, const char *name) {
  void *found = dlsym(RTLD_NEXT, name);
  memcpy(function, &found, sizeof found);
}

static int real_clock(clockid_t clock, struct timespec *now) {
  int (*real)(clockid_t, struct timespec *);
  find(&real, "clock_gettime");
  return real(clock, now);
}

static long jump(void) {
  struct timespec since_start = {0};
  real_clock(CLOCK_MONOTONIC, &since_start);
  return since_start.tv_sec % 10 < 5 ? number("CHAOS_CLOCK") : 0;
}

int clock_gettime(clockid_t clock, struct timespec *now) {
  int status = real_clock(clock, now);
  if (status == 0 && clock == CLOCK_REALTIME)
    now->tv_sec += jump();
  return status;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone) {
  int (*real)(struct timeval *, void *);
  find(&real, "gettimeofday");
  int status = real(now, zone);
  if (status == 0)
    now->tv_sec += jump();
  return status;
}

static int is_lock_file(int file) {
  char link[64], path[4096];
  snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  ssize_t length = readlink(link, path, sizeof path);
  return length > 5 && memcmp(path + length - 5, ".lock", 5) == 0;
}

static int control(const char *name, int file, int command, void *value) {
  static unsigned requests;
  long one_of = number("CHAOS_LOCKS");
  if (one_of > 0 && (command == F_SETLK || command == F_SETLKW)) {
    if (is_lock_file(file))
      return 0;
    if (((struct flock *)value)->l_type != F_UNLCK && ++requests % (unsigned)one_of == 0) {
      errno = ENOLCK;
      return -1;
    }
  }
  int (*real)(int, int, ...);
  find(&real, name);
  return real(file, command, value);
}

int fcntl(int file, int command, ...) {
  va_list values;
  va_start(values, command);
  void *value = va_arg(values, void *);
  va_end(values);
  return control("fcntl", file, command, value);
}

int fcntl64(int file, int command, ...) {
  va_list values;
  va_start(values, command);
  void *value = va_arg(values, void *);
  va_end(values);
  return control("fcntl64", file, command, value);
}
