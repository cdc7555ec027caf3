#include "scene/scene.h"
const char *scene_unit(const struct scene *scene, const char *dimension)
{
    (void)scene;
    (void)dimension;
    return "";
}
