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

/* The functions that this library replaces. They are looked up once, before main: dlsym waits for the lock of the loader, and a
 * thread that imports a module can hold this lock while it waits for Python's. */
static int (*real_clock)(clockid_t, struct timespec *);
static int (*real_time)(struct timeval *, void *);
static int (*real_fcntl)(int, int, ...);
static int (*real_fcntl64)(int, int, ...);

static void look_up(void *function, const char *name) {
  void *address = dlsym(RTLD_NEXT, name);
  memcpy(function, &address, sizeof address);
}

__attribute__((constructor)) static void look_up_all(void) {
  if (real_clock)
    return;
  look_up(&real_time, "gettimeofday");
  look_up(&real_fcntl, "fcntl");
  look_up(&real_fcntl64, "fcntl64");
  look_up(&real_clock, "clock_gettime");
}

static long jump(void) {
  struct timespec since_start = {0};
  real_clock(CLOCK_MONOTONIC, &since_start);
  return since_start.tv_sec % 10 < 5 ? number("CHAOS_CLOCK") : 0;
}

int clock_gettime(clockid_t clock, struct timespec *now) {
  look_up_all(); /* a constructor of another library can be earlier */
  int status = real_clock(clock, now);
  if (status == 0 && clock == CLOCK_REALTIME)
    now->tv_sec += jump();
  return status;
}

int gettimeofday(struct timeval *restrict now, void *restrict zone) {
  look_up_all();
  int status = real_time(now, zone);
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

static int control(int (*real)(int, int, ...), int file, int command, void *value) {
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
  return real(file, command, value);
}

int fcntl(int file, int command, ...) {
  va_list values;
  va_start(values, command);
  void *value = va_arg(values, void *);
  va_end(values);
  look_up_all();
  return control(real_fcntl, file, command, value);
}

int fcntl64(int file, int command, ...) {
  va_list values;
  va_start(values, command);
  void *value = va_arg(values, void *);
  va_end(values);
  look_up_all();
  return control(real_fcntl64, file, command, value);
}
