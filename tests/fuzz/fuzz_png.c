/* fuzz_png.c - any bytes as the picture of `frame --against`: read, compared and drawn, or refused.
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include "draw/difference.h"

#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct image image, black, difference;
    struct error error;
    int largest;
    uint64_t differing;
    if (!image_decode(&image, data, size, &error)) return 0;
    if (image_create(&black, image.width, image.height, &error)) {
        if (!image_compare(&image, &black, 3, &largest, &differing)) abort();
        if (difference_draw(&image, &black, 3, &difference, &error)) image_free(&difference);
        image_free(&black);
    }
    image_free(&image);
    return 0;
}
