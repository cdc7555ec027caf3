/* replay.c - tries every file of a corpus once: what the fuzz targets do without libFuzzer.
 *
 *     fuzz_TARGET FOLDER
 *
 * Each file is also tried cut in half and with one byte changed in many places, so that the quick
 * suite sees broken input with any compiler.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "base/file.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

enum { CHANGES = 40 };

static unsigned try_all(uint8_t *data, size_t size)
{
    LLVMFuzzerTestOneInput(data, size);
    LLVMFuzzerTestOneInput(data, size / 2);
    unsigned tries = 2;
    for (size_t k = 0; k < CHANGES && size > 0; k++, tries++) {
        const size_t at = (k * 2654435761u + 17 * k) % size;
        const uint8_t kept = data[at];
        data[at] = (uint8_t)(kept ^ (1u << k % 8));
        LLVMFuzzerTestOneInput(data, size);
        data[at] = kept;
    }
    return tries;
}

int main(int count, char **arguments)
{
    DIR *list = count == 2 ? opendir(arguments[1]) : NULL;
    unsigned files = 0, tries = 0;
    if (!list) return 2;
    for (struct dirent *entry; (entry = readdir(list));) {
        char path[FILE_PATH_MAX];
        struct error error;
        size_t size;
        if (entry->d_name[0] == '.') continue;
        snprintf(path, sizeof path, "%s/%s", arguments[1], entry->d_name);
        uint8_t *data = file_load(path, (size_t)1 << 24, &size, &error);
        if (!data) {
            fprintf(stderr, "%s\n", error.text);
            closedir(list);
            return 1;
        }
        tries += try_all(data, size);
        files++;
        free(data);
    }
    closedir(list);
    printf("%u files, %u tries\n", files, tries);
    return files > 0 ? 0 : 1;
}
