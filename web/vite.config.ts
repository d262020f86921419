import { defineConfig } from 'vite';

// Asset addresses are relative, so that limnd may serve the page below any --base-path.
// Nothing is inlined: the page runs under a Content-Security-Policy of 'self'.
export default defineConfig({
  base: './',
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    chunkSizeWarningLimit: 300,
  },
  worker: { format: 'es' },
  // `npm run dev` shows the page of the source tree; what it asks for goes on to a server at limnd's usual address.
  server: {
    host: '127.0.0.1',
    proxy: {
      '/ws': { target: 'ws://127.0.0.1:8080', ws: true },
      '/readyz': 'http://127.0.0.1:8080',
    },
  },
  test: { include: ['test/**/*.test.ts'], environment: 'node' },
} as Parameters<typeof defineConfig>[0]);
