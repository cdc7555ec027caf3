/* faulty.c - runs a program and lets one of its system calls that change files go wrong.
 *
 *     faulty COUNT_FILE NUMBER kill|full PROGRAM ARGUMENTS...
 *
 * Counts the calls of PROGRAM and its children that create, write, sync, rename, remove or cut
 * files (standard streams aside) and writes how many there were into COUNT_FILE.  `kill`: the
 * NUMBER'th never returns, the process is killed in it.  `full`: from the NUMBER'th on, all that
 * would need space fail with ENOSPC, as on a full disk.  NUMBER 0 only counts.  Ends as PROGRAM
 * does (128 + signal if that ended it); 77 if the kernel offers no such thing.
 *
 * A seccomp filter hands the calls to this process, which lets them continue or not.
 *
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include <errno.h>
#include <fcntl.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <signal.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

enum { SKIPPED = 77 };

/* X(call, does it need space?) - calls whose first argument is a stream come in a second list */
#define NAMING(X)                                                                       \
    X(rename, 1) X(renameat, 1) X(renameat2, 1) X(mkdir, 1) X(mkdirat, 1)               \
    X(unlink, 0) X(unlinkat, 0) X(rmdir, 0)
#define STREAMING(X)                                                                    \
    X(write, 1) X(writev, 1) X(pwrite64, 1) X(fsync, 1) X(fdatasync, 1) X(ftruncate, 0)

#define NUMBER_AT offsetof(struct seccomp_data, nr)
#define ARGUMENT_AT(k) (uint32_t)(offsetof(struct seccomp_data, args) + 8 * (k))
#define LOAD(at) BPF_STMT(BPF_LD | BPF_W | BPF_ABS, at)
#define END(what) BPF_STMT(BPF_RET | BPF_K, what)

static int install(void)
{
    const uint32_t opens = O_WRONLY | O_RDWR | O_CREAT | O_TRUNC;
    struct sock_filter code[] = {
        LOAD(NUMBER_AT),
#define X(call, space) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_##call, 0, 1),                \
                       END(SECCOMP_RET_USER_NOTIF),
        NAMING(X)
#undef X
#define X(call, space) BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_##call, 0, 4),                \
                       LOAD(ARGUMENT_AT(0)),                                                 \
                       BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, 2, 0, 1),                         \
                       END(SECCOMP_RET_USER_NOTIF), END(SECCOMP_RET_ALLOW),
        STREAMING(X)
#undef X
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, SYS_openat, 0, 3),
        LOAD(ARGUMENT_AT(2)),
        BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, opens, 0, 1),
        END(SECCOMP_RET_USER_NOTIF),
        END(SECCOMP_RET_ALLOW),
    };
    const struct sock_fprog filter = {sizeof code / sizeof *code, code};
    if (prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0) return -1;
    return (int)syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_NEW_LISTENER,
                        &filter);
}

static bool needs_space(const struct seccomp_notif *call)
{
    switch (call->data.nr) {
#define X(name, space) case SYS_##name: return space;
    NAMING(X) STREAMING(X)
#undef X
    default: return true;       /* openat */
    }
}

/* Hands the listener over to the parent. */
static bool send_stream(int socket, int stream)
{
    char byte = 0, space[CMSG_SPACE(sizeof(int))] = {0};
    struct iovec piece = {&byte, 1};
    struct msghdr message = {.msg_iov = &piece, .msg_iovlen = 1, .msg_control = space,
                             .msg_controllen = sizeof space};
    struct cmsghdr *head = CMSG_FIRSTHDR(&message);
    *head = (struct cmsghdr){CMSG_LEN(sizeof(int)), SOL_SOCKET, SCM_RIGHTS};
    memcpy(CMSG_DATA(head), &stream, sizeof stream);
    return sendmsg(socket, &message, 0) == 1;
}

static int receive_stream(int socket)
{
    char byte = 0, space[CMSG_SPACE(sizeof(int))] = {0};
    struct iovec piece = {&byte, 1};
    struct msghdr message = {.msg_iov = &piece, .msg_iovlen = 1, .msg_control = space,
                             .msg_controllen = sizeof space};
    int stream = -1;
    if (recvmsg(socket, &message, 0) != 1 || !CMSG_FIRSTHDR(&message)) return -1;
    memcpy(&stream, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof stream);
    return stream;
}

/* Answers until the program has ended; returns how many calls there were. */
static unsigned long serve(int listener, pid_t child, unsigned long number, bool kills, int *status)
{
    unsigned long count = 0;
    struct pollfd wait = {.fd = listener, .events = POLLIN};
    while (waitpid(child, status, WNOHANG) == 0) {
        struct seccomp_notif call = {0};
        if (poll(&wait, 1, 20) <= 0 || !(wait.revents & POLLIN)) continue;
        if (ioctl(listener, SECCOMP_IOCTL_NOTIF_RECV, &call) != 0) continue;
        struct seccomp_notif_resp answer = {.id = call.id,
                                            .flags = SECCOMP_USER_NOTIF_FLAG_CONTINUE};
        count++;
        if (number > 0 && kills && count == number) {
            kill(child, SIGKILL);
            continue;
        }
        if (number > 0 && !kills && count >= number && needs_space(&call)) {
            answer.flags = 0;
            answer.error = -ENOSPC;
        }
        ioctl(listener, SECCOMP_IOCTL_NOTIF_SEND, &answer);
    }
    return count;
}

int main(int argument_count, char **arguments)
{
    int ends[2], status = 0;
    if (argument_count < 5 || socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        return 2;
    }
    const pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        const int listener = install();
        if (listener < 0 || !send_stream(ends[1], listener)) _exit(SKIPPED);
        close(listener);
        execvp(arguments[4], arguments + 4);
        _exit(127);
    }
    close(ends[1]);
    const int listener = receive_stream(ends[0]);
    if (listener < 0) return SKIPPED;
    const unsigned long count = serve(listener, child, strtoul(arguments[2], NULL, 10),
                                      strcmp(arguments[3], "kill") == 0, &status);
    FILE *out = fopen(arguments[1], "w");
    if (!out || fprintf(out, "%lu\n", count) < 0 || fclose(out) != 0) return 2;
    return WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
}
