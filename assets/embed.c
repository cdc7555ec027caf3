/* embed.c - build tool: writes a C file that holds the files named on the command line.
 *
 *     embed OUT.c ROOT FILE...        FILE is stored under its path below ROOT
 * SPDX-License-Identifier: GPL-3.0-or-later
 */
#include <stdio.h>
#include <string.h>

static int embed_one(FILE *out, const char *path, int index)
{
    FILE *in = fopen(path, "rb");
    if (!in) { perror(path); return 1; }
    fprintf(out, "static const unsigned char bytes_%d[] = {", index);
    size_t size = 0;
    for (int c; (c = getc(in)) != EOF; size++) fprintf(out, "%s%d,", size % 24 ? "" : "\n", c);
    fprintf(out, "0};\nenum { size_%d = %zu };\n", index, size);
    fclose(in);
    return 0;
}

int main(int argc, char **argv)
{
    if (argc < 3) return 2;
    FILE *out = fopen(argv[1], "w");
    if (!out) { perror(argv[1]); return 1; }
    fprintf(out, "#include \"base/asset.h\"\n");
    const size_t root = strlen(argv[2]) + 1;
    for (int k = 3; k < argc; k++) {
        if (strncmp(argv[k], argv[2], root - 1) == 0) continue;
        fprintf(stderr, "embed: %s does not lie below %s\n", argv[k], argv[2]);
        return 1;
    }
    for (int k = 3; k < argc; k++) if (embed_one(out, argv[k], k) != 0) return 1;
    fprintf(out, "const struct asset asset_list[] = {\n");
    for (int k = 3; k < argc; k++) {
        fprintf(out, "    {\"%s\", bytes_%d, size_%d},\n", argv[k] + root, k, k);
    }
    fprintf(out, "    {0, 0, 0}};\n");
    return fclose(out) != 0;
}
