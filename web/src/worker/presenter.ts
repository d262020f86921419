import type { EncodedFrame } from './decode_queue';
import type { Area, PixelHash } from '../channel';

/** The canvas: draws decoded pictures at the display's pace and reads them back for tests. */
export class Presenter {
  private context: OffscreenCanvasRenderingContext2D;
  private hidden = false;
  private drawn = false;

  constructor(private readonly canvas: OffscreenCanvas) {
    const context = canvas.getContext('2d', { alpha: false, colorSpace: 'srgb' });
    if (!context) throw new Error('this browser gives no 2D context for an OffscreenCanvas');
    this.context = context;
  }

  setHidden(hidden: boolean): void {
    this.hidden = hidden;
  }

  /** The bytes as pixels, untouched by colour management. */
  static decode(frame: EncodedFrame): Promise<ImageBitmap> {
    const type = frame.header.encoding === 'png' ? 'image/png' : 'image/jpeg';
    const blob = new Blob([frame.payload as Uint8Array<ArrayBuffer>], { type });
    return createImageBitmap(blob, { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
  }

  /**
   * Draws with the next display frame. At once when the page is hidden, as no display frame would come, and when the
   * canvas is empty, as the first one comes late to a worker that has just begun.
   */
  async present(frame: EncodedFrame, picture: ImageBitmap): Promise<void> {
    if (!this.hidden && this.drawn) await nextDisplayFrame();
    this.drawn = true;
    const { x, y, width, height, fullWidth, fullHeight } = frame.header;
    if (this.canvas.width !== fullWidth || this.canvas.height !== fullHeight) {
      this.canvas.width = fullWidth;
      this.canvas.height = fullHeight;
    }
    this.context.imageSmoothingEnabled = true;
    this.context.imageSmoothingQuality = 'low';
    this.context.drawImage(picture, x, y, width, height);
    picture.close();
  }

  /** What the canvas shows, as a PNG file. */
  png(): Promise<Blob> {
    return this.canvas.convertToBlob({ type: 'image/png' });
  }

  /** SHA-256 over the canvas' RGBA bytes, row 0 on top. Test hook. */
  async hash(): Promise<PixelHash> {
    const { width, height } = this.canvas;
    const pixels = this.context.getImageData(0, 0, width, height).data;
    const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', pixels));
    const sha256 = [...digest].map((byte) => byte.toString(16).padStart(2, '0')).join('');
    return { width, height, sha256, distinct: countDistinct(pixels) };
  }

  /** Mean sRGB value of an area, 0..255. Test hook. */
  mean({ x, y, width, height }: Area): [number, number, number] {
    const pixels = this.context.getImageData(x, y, width, height).data;
    const sum: [number, number, number] = [0, 0, 0];
    for (let i = 0; i < pixels.length; i++) if (i % 4 < 3) sum[i % 4]! += pixels[i]!;
    const count = pixels.length / 4;
    return [sum[0] / count, sum[1] / count, sum[2] / count];
  }
}

// A display frame that does not come within this time (covered window) must not hold the credits back.
const kLongestWaitMs = 100;

function nextDisplayFrame(): Promise<void> {
  return new Promise((resolve) => {
    const timer = setTimeout(resolve, kLongestWaitMs);
    requestAnimationFrame(() => {
      clearTimeout(timer);
      resolve();
    });
  });
}

/** Number of different colours, up to 256: more than one means that there is a picture. */
function countDistinct(rgba: Uint8ClampedArray): number {
  const words = new Uint32Array(rgba.buffer, rgba.byteOffset, rgba.length / 4);
  const seen = new Set<number>();
  for (const word of words) {
    seen.add(word);
    if (seen.size === 256) break;
  }
  return seen.size;
}
