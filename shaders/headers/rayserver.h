/* SPDX-License-Identifier: Apache-2.0
 * Renderers without rays need this header to get them; here trace(), fulltrace(), visibility(), rayhittest(),
 * raylevel() and isshadowray() are built in. */
#ifndef RAYSERVER_H
#define RAYSERVER_H 1
#endif
