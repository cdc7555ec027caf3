/* shim.c - preloaded into the program by test_faults.py: a failing allocator, a missing library
 * and a clock that jumps.
 *
 *     SHIM_ALLOCATION=N      the N'th allocation that the program itself asks for fails, and so
 *                            does every later one if SHIM_FOREVER is set
 *     SHIM_COUNT=FILE        gets how many there were
 *     SHIM_NO_LIBRARY=WORD   no library whose name holds WORD can be opened
 *     SHIM_CLOCK=1           the date jumps by decades with every look at it
 *
 * What the program starts (ffmpeg, gnuplot, the runs of a sweep) is left alone.
 *
 * Only calls from the program's own code count, through which jansson takes its memory, too: what
 * happens when Mesa or libconfig run out of memory is not ours to decide.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <link.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

extern void *__libc_malloc(size_t);
extern void *__libc_calloc(size_t, size_t);
extern void *__libc_realloc(void *, size_t);
extern void *__libc_memalign(size_t, size_t);

static uintptr_t code_begin, code_end;  /* of the program */
static atomic_ulong allocations;
static unsigned long failing;
static bool forever, jumps;
static char count_path[400];

static int find_program(struct dl_phdr_info *info, size_t size, void *unused)
{
    (void)size;
    (void)unused;
    for (int k = 0; k < info->dlpi_phnum; k++) {
        const ElfW(Phdr) *part = &info->dlpi_phdr[k];
        if (part->p_type != PT_LOAD || !(part->p_flags & PF_X)) continue;
        code_begin = info->dlpi_addr + part->p_vaddr;
        code_end = code_begin + part->p_memsz;
    }
    return 1;                   /* the program comes first */
}

__attribute__((constructor)) static void begin(void)
{
    const char *number = getenv("SHIM_ALLOCATION"), *path = getenv("SHIM_COUNT");
    if (path) snprintf(count_path, sizeof count_path, "%s", path);
    failing = number ? strtoul(number, NULL, 10) : 0;
    forever = getenv("SHIM_FOREVER") != NULL;
    jumps = getenv("SHIM_CLOCK") != NULL;
    unsetenv("LD_PRELOAD");
    dl_iterate_phdr(find_program, NULL);
}

__attribute__((destructor)) static void end(void)
{
    char text[32];
    const int file = count_path[0] ? open(count_path, O_WRONLY | O_CREAT | O_TRUNC, 0666) : -1;
    if (file < 0) return;
    const int size = snprintf(text, sizeof text, "%lu\n", (unsigned long)allocations);
    if (write(file, text, (size_t)size) != size) _exit(99);
    close(file);
}

static bool fails(const void *caller)
{
    const uintptr_t from = (uintptr_t)caller;
    if (from < code_begin || from >= code_end) return false;
    const unsigned long number = atomic_fetch_add(&allocations, 1) + 1;
    if (failing == 0 || number < failing || (number > failing && !forever)) return false;
    errno = ENOMEM;
    return true;
}

#define FAILS fails(__builtin_return_address(0))

void *malloc(size_t size) { return FAILS ? NULL : __libc_malloc(size); }

void *calloc(size_t count, size_t size) { return FAILS ? NULL : __libc_calloc(count, size); }

void *realloc(void *old, size_t size) { return FAILS ? NULL : __libc_realloc(old, size); }

void *aligned_alloc(size_t alignment, size_t size)
{
    return FAILS ? NULL : __libc_memalign(alignment, size);
}

char *strdup(const char *text)
{
    const size_t size = strlen(text) + 1;
    char *copy = FAILS ? NULL : __libc_malloc(size);
    return copy ? memcpy(copy, text, size) : NULL;
}

void *dlopen(const char *name, int mode)
{
    static void *(*real)(const char *, int);
    const char *missing = getenv("SHIM_NO_LIBRARY");
    if (name && missing && strstr(name, missing)) return NULL;
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, "dlopen");
    return real(name, mode);
}

int clock_gettime(clockid_t clock, struct timespec *now)
{
    static int (*real)(clockid_t, struct timespec *);
    if (!real) *(void **)&real = dlsym(RTLD_NEXT, "clock_gettime");
    const int done = real(clock, now);
    if (jumps && clock == CLOCK_REALTIME) now->tv_sec = time(NULL);
    return done;
}

time_t time(time_t *out)
{
    static atomic_ulong looks;
    struct timespec now;
    static const time_t decades = 1000000000;
    timespec_get(&now, TIME_UTC);
    if (jumps) now.tv_sec += atomic_fetch_add(&looks, 1) % 2 ? decades : -decades;
    if (out) *out = now.tv_sec;
    return now.tv_sec;
}
