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
  server: { host: '127.0.0.1' },
  test: { include: ['test/**/*.test.ts'], environment: 'node' },
} as Parameters<typeof defineConfig>[0]);
